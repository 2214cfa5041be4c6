/** What is asked of columns, and the rules that were kept of it. */

import { AREAS, type Area, type AreaKind } from "../data/area.js";
import { columnsOf } from "../data/cloud.js";
import type { ColumnSpan } from "../data/filter.js";
import { ARTIFACT, isClass, PLAUSIBLE } from "../data/labels.js";
import { type Rule, type Verdict, verdictOf, verdictText } from "../data/rules.js";
import { childrenOf, h, type Option, pressed, say, select, setOptions } from "../dom.js";
import type { Page } from "../page.js";
import type { State } from "../state.js";
import { textButton } from "./buttons.js";

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

function spans(page: Page): HTMLElement {
  const rows = h("div", {});
  const put = childrenOf<ColumnSpan>(
    rows,
    ({ name }) => name,
    ({ name }) => columnRow(page, name),
    (row, { span }) => {
      row
        .querySelectorAll("input")
        .forEach((field, i) => (field.value = Number.isFinite(span[i]) ? String(span[i]) : ""));
    },
  );
  page.store.watch(
    ({ filter }) => [filter.columns],
    (columns) => put(columns),
  );
  return rows;
}

function columnRow({ store, actions }: Page, name: string): HTMLElement {
  const set = (change: (one: ColumnSpan) => readonly ColumnSpan[]): void => {
    const { columns } = store.state.filter;
    actions.view.filter({ columns: columns.flatMap((one) => (one.name === name ? change(one) : [one])) });
  };
  const end = (index: 0 | 1, label: string): HTMLInputElement => {
    const change = (): void =>
      set(({ span }) => {
        const now: [number, number] = [...span];
        const open = index === 0 ? -Infinity : Infinity;
        now[index] = Number.isNaN(field.valueAsNumber) ? open : field.valueAsNumber;
        return [{ name, span: now }];
      });
    const attributes = { type: "number", step: "any", "aria-label": `${name}: ${label}`, placeholder: label };
    const field = h("input", { ...attributes, on: { change } });
    return field;
  };
  const away = textButton("link", `Ask nothing of ${name}`, "×", () => set(() => []));
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
    return textButton("chip small", title, text, () => actions.view.draw(kind));
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
  const put = childrenOf<Area>(
    rows,
    (area) => area,
    (area) => {
      const text = `${DRAWN[area.kind][0].toLowerCase()} in ${area.sequence}`;
      const away = textButton("link", `Ask nothing of the place ${text}`, "×", () => without(area));
      return h("div", { class: "row" }, h("span", { class: "faint" }, text), away);
    },
  );
  store.watch(
    ({ filter }) => [filter.areas],
    (now) => put(now),
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
function kept(page: Page): HTMLElement {
  const list = h("div", { class: "row wrap", role: "group", "aria-label": "Rules" });
  const put = childrenOf<Rule>(
    list,
    (rule) => rule,
    (rule) => ruleRow(page, rule),
  );
  page.store.watch(
    ({ rules }) => [rules],
    (rules) => put(rules),
  );
  return list;
}

function ruleRow({ actions }: Page, { name, sets }: Rule): HTMLElement {
  const use = `Select what ${name} lets through in the whole sequence`;
  const everywhere = `What ${name} would change in all of your sequences`;
  return h(
    "span",
    { class: "row" },
    textButton("chip small", use, name, () => void actions.rule.choose(name)),
    sets === null ? null : textButton("link", everywhere, "all", () => void actions.replay.start(name)),
    textButton("link", `Forget ${name}`, "×", () => actions.rule.forget(name)),
  );
}
