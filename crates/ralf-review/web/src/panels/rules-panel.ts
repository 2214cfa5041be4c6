/** What is asked of columns, and the rules that were kept of it. */

import { AREAS, type Area, type AreaKind } from "../data/area.js";
import { columnsOf } from "../data/cloud.js";
import type { ColumnSpan } from "../data/filter.js";
import { ARTIFACT, isClass, PLAUSIBLE } from "../data/labels.js";
import { type Verdict, verdictOf, verdictText } from "../data/rules.js";
import { h, type Option, pressed, say, select, setOptions } from "../dom.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";

export function rulesPanel(page: Page): HTMLElement {
  const count = h("span", { class: "faint" });
  page.store.watch(
    ({ filter, rules }) => [filter, rules],
    ({ columns, areas: places }, rules) => say(count, `${columns.length + places.length} asked, ${rules.length} kept`),
  );
  const summary = h("summary", { title: "Filters on every column and on places, kept by name" }, "Rules ", count);
  return h(
    "details",
    {},
    summary,
    h("div", { class: "rules" }, columnList(page), spans(page), drawing(page), areas(page), saving(page), kept(page)),
  );
}

/** Adds a column to what is asked. */
function columnList({ store, actions }: Page): HTMLSelectElement {
  const list = select("Column to filter by", [], (name) => {
    const { columns } = store.state.filter;
    if (name !== "" && columns.every((known) => known.name !== name))
      actions.view.filter({ columns: [...columns, { name, span: [-Infinity, Infinity] }] });
    list.value = "";
  });
  store.watch(
    ({ cloud }) => [cloud.scans[0]?.table],
    () => {
      const columns = columnsOf(store.state.cloud);
      const options = columns.map(({ name, unit, meaning }) => ({ value: name, text: named(name, unit), meaning }));
      setOptions(list, [{ value: "", text: "add a column…" }, ...options]);
    },
  );
  return list;
}

function named(name: string, unit: string): string {
  return unit === "" ? name : `${name} / ${unit}`;
}

function spans({ store, actions }: Page): HTMLElement {
  const rows = h("div", {});
  const set = (name: string, span: ColumnSpan["span"] | null): void => {
    const others = store.state.filter.columns.flatMap((one) =>
      one.name !== name ? [one] : span === null ? [] : [{ name, span }],
    );
    actions.view.filter({ columns: others });
  };
  store.watch(
    ({ filter }) => [filter.columns],
    (columns) => rows.replaceChildren(...columns.map((column) => row(column, (span) => set(column.name, span)))),
  );
  return rows;
}

function row({ name, span }: ColumnSpan, set: (span: ColumnSpan["span"] | null) => void): HTMLElement {
  const end = (index: 0 | 1, label: string): HTMLInputElement => {
    const field = h("input", {
      type: "number",
      step: "any",
      "aria-label": `${name}: ${label}`,
      placeholder: label,
      value: Number.isFinite(span[index]) ? String(span[index]) : "",
      on: {
        change: () => {
          const open = index === 0 ? -Infinity : Infinity;
          const now: [number, number] = [...span];
          now[index] = Number.isNaN(field.valueAsNumber) ? open : field.valueAsNumber;
          set(now);
        },
      },
    });
    return field;
  };
  const away = h("button", {
    class: "link",
    type: "button",
    title: `Ask nothing of ${name}`,
    on: { click: () => set(null) },
  });
  away.append("×");
  return h("div", { class: "row rule" }, h("span", { class: "faint" }, name), end(0, "least"), end(1, "most"), away);
}

const DRAWN: Readonly<Record<AreaKind, readonly [text: string, title: string]>> = {
  inside: ["Inside", "Draw an outline: only what lies inside"],
  behind: ["Behind", "Draw along a surface: only what its radar sees behind it"],
  mirror: ["Mirrored", "Draw along a surface: only what lies behind it where it mirrors something plausible"],
};

/** Says by a stroke in the scene where something is asked for. */
function drawing({ store, actions }: Page): HTMLElement {
  const chips = AREAS.map((kind) => {
    const [text, title] = DRAWN[kind];
    const chip = h("button", {
      class: "chip small",
      type: "button",
      title,
      on: { click: () => actions.view.draw(kind) },
    });
    chip.append(text);
    return chip;
  });
  store.watch(
    ({ drawing: now }) => [now],
    (now) => AREAS.forEach((kind, i) => pressed(chips[i], kind === now)),
  );
  return h("div", { class: "row", role: "group", "aria-label": "Draw where" }, ...chips);
}

function areas({ store, actions }: Page): HTMLElement {
  const rows = h("div", {});
  const without = (area: Area): void =>
    actions.view.filter({ areas: store.state.filter.areas.filter((other) => other !== area) });
  store.watch(
    ({ filter }) => [filter.areas],
    (now) =>
      rows.replaceChildren(
        ...now.map((area) => {
          const text = `${DRAWN[area.kind][0].toLowerCase()} in ${area.sequence}`;
          const away = h("button", {
            class: "link",
            type: "button",
            title: `Ask nothing of the place ${text}`,
            on: { click: () => without(area) },
          });
          away.append("×");
          return h("div", { class: "row" }, h("span", { class: "faint" }, text), away);
        }),
      ),
  );
  return rows;
}

function saving({ store, actions }: Page): HTMLElement {
  const sets = select("What the rule sets", verdicts(store.state), () => undefined);
  const name = h("input", { type: "text", "aria-label": "Name of the rule", placeholder: "name", maxlength: "64" });
  const save = h("button", { class: "chip small", type: "submit" }, "Keep");
  const form = h("form", { class: "row keep-rule" }, name, sets, save);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    actions.rule.save(name.value, verdictOf(sets.value));
    [name.value, sets.value] = ["", ""];
  });
  return form;
}

/** Everything that a rule may say: nothing, a label, an artifact and its cause, a class. */
function verdicts({ labels, recording }: Readonly<State>): readonly Option[] {
  const option = (sets: Verdict | null, text: string): Option => ({ value: verdictText(sets), text });
  const causes = recording.sayable_causes.filter((cause) => cause !== "");
  const classes = labels.classes.filter(({ id }) => isClass(id));
  return [
    option(null, "only selects"),
    ...[PLAUSIBLE, ARTIFACT].map((label) => option({ label, cause: null }, `sets ${labels.name(label)}`)),
    ...causes.map((cause) => option({ label: ARTIFACT, cause }, `sets artifact: ${cause}`)),
    ...classes.map(({ id, name }) => option({ label: id, cause: null }, `sets ${name}`)),
  ];
}

/** The rules that were kept: each can be asked of the sequence on screen. */
function kept({ store, actions }: Page): HTMLElement {
  const list = h("div", { class: "row wrap", role: "group", "aria-label": "Rules" });
  store.watch(
    ({ rules }) => [rules],
    (rules) =>
      list.replaceChildren(
        ...rules.map(({ name, sets }) => {
          const title = `Select what ${name} lets through in the whole sequence`;
          const use = h("button", {
            class: "chip small",
            type: "button",
            title,
            on: { click: () => void actions.rule.choose(name) },
          });
          use.append(name);
          const away = h("button", {
            class: "link",
            type: "button",
            title: `Forget ${name}`,
            on: { click: () => actions.rule.forget(name) },
          });
          away.append("×");
          const everywhere = h("button", {
            class: "link",
            type: "button",
            title: `What ${name} would change in all of your sequences`,
            on: { click: () => void actions.replay.start(name) },
          });
          everywhere.append("all");
          return h("span", { class: "row" }, use, sets === null ? null : everywhere, away);
        }),
      ),
  );
  return list;
}
