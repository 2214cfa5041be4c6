/** Which detections are shown: by label, origin, score, range, height, class, flags and radar. */

import { everything, type Filter, hides, type Origin, type Span } from "../data/filter.js";
import { childrenOf, h, pressed, say, select } from "../dom.js";
import { shortName } from "../format.js";
import type { Page } from "../page.js";
import { chip } from "./buttons.js";
import { classFilter } from "./class-filter.js";
import { rulesPanel } from "./rules-panel.js";

export function filterPanel(page: Page): HTMLElement {
  const { store, actions } = page;
  const count = h("span", { class: "faint number" });
  const all = h(
    "button",
    { class: "link", type: "button", title: "Show everything (0)", on: { click: () => actions.view.showEverything() } },
    "show all",
  );
  store.watch(
    ({ shown, filter }) => [shown, filter],
    (shown, filter) => {
      let seen = 0;
      for (const value of shown) seen += value;
      say(count, `${seen.toLocaleString("en")} of ${shown.length.toLocaleString("en")}`);
      all.hidden = !hides(filter);
    },
  );
  return h(
    "section",
    { class: "filters", "aria-label": "Filter" },
    h("header", {}, h("h2", {}, "Shown"), count, all),
    labels(page),
    origin(page),
    span(page, "score", "w", "0.05", everything.score),
    span(page, "range", "range / m", "5", everything.range),
    span(page, "height", "z / m", "0.5", everything.height),
    classFilter(page),
    flags(page),
    radars(page),
    rulesPanel(page),
  );
}

function labels({ store, actions }: Page): HTMLElement {
  const names = ["plausible", "artifact", "unlabelled"] as const;
  const buttons = names.map((name) =>
    chip(name, name, () => actions.view.filter({ [name]: !store.state.filter[name] })),
  );
  store.watch(
    ({ filter }) => [filter],
    (filter) => names.forEach((name, i) => pressed(buttons[i], filter[name])),
  );
  return h("div", { class: "row", role: "group", "aria-label": "Labels shown" }, ...buttons);
}

function origin({ store, actions }: Page): HTMLElement {
  const options = [
    { value: "any", text: "by anyone" },
    { value: "machine", text: "by machine" },
    { value: "corrected", text: "corrected" },
  ];
  const list = select("Labelled by", options, (value) => actions.view.filter({ origin: value as Origin }));
  const uncertain = chip("only uncertain", "uncertain", () =>
    actions.view.filter({ uncertain: !store.state.filter.uncertain }),
  );
  store.watch(
    ({ filter }) => [filter],
    (filter) => {
      list.value = filter.origin;
      pressed(uncertain, filter.uncertain);
    },
  );
  return h("div", { class: "row" }, list, uncertain);
}

type SpanName = "score" | "range" | "height";

function span({ store, actions }: Page, name: SpanName, text: string, step: string, whole: Span): HTMLElement {
  const end = (index: 0 | 1, label: string): HTMLInputElement => {
    const field = h("input", {
      type: "number",
      step,
      "aria-label": `${text}: ${label}`,
      placeholder: label,
      on: {
        change: () => {
          const now: [number, number] = [...store.state.filter[name]];
          now[index] = Number.isNaN(field.valueAsNumber) ? whole[index] : field.valueAsNumber;
          actions.view.filter({ [name]: now } as Partial<Filter>);
        },
      },
    });
    return field;
  };
  const [least, most] = [end(0, "least"), end(1, "most")];
  store.watch(
    ({ filter }) => [filter[name]],
    (now) => {
      least.value = now[0] === whole[0] ? "" : String(now[0]);
      most.value = now[1] === whole[1] ? "" : String(now[1]);
    },
  );
  return h("div", { class: "row span" }, h("span", { class: "faint" }, text), least, most);
}

function flags({ store, actions }: Page): HTMLElement {
  const buttons = store.state.recording.flags.map(({ bit, name }) => ({
    bit,
    button: chip(name, "flag", () => actions.view.filter({ flags: store.state.filter.flags ^ bit })),
  }));
  store.watch(
    ({ filter }) => [filter.flags],
    (now) => {
      for (const { bit, button } of buttons) pressed(button, (now & bit) !== 0);
    },
  );
  const chosen = h("span", { class: "faint" });
  store.watch(
    ({ filter }) => [filter.flags],
    (now) => say(chosen, now === 0 ? "any" : `${buttons.filter(({ bit }) => (now & bit) !== 0).length} chosen`),
  );
  return h(
    "details",
    {},
    h("summary", { title: "Only detections with one of the chosen flags" }, "Flags ", chosen),
    h(
      "div",
      { class: "row wrap", role: "group", "aria-label": "Only with these flags" },
      ...buttons.map(({ button }) => button),
    ),
  );
}

function radars({ store, actions }: Page): HTMLElement {
  const row = h("div", { class: "row wrap", role: "group", "aria-label": "Radars shown" });
  const put = childrenOf<string>(
    row,
    (name) => name,
    (name) => chip(shortName(name), "radar", () => actions.view.toggleRadar(name)),
    (button, name) => pressed(button, !store.state.filter.hiddenRadars.has(name)),
  );
  store.watch(
    ({ recording, sequence, filter }) => [recording, sequence, filter.hiddenRadars],
    (recording, sequence) =>
      put(recording.sequences.find(({ name }) => name === sequence)?.radars.map(({ name }) => name) ?? []),
  );
  return row;
}
