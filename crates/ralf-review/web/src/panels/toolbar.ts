/** Tools, labels, history: what corrects. */

import { ARTIFACT, type Choice, PLAUSIBLE } from "../data/labels.js";
import { h, pressed, say } from "../dom.js";
import type { Page } from "../page.js";
import { TOOLS, type Tool } from "../selection/tools.js";
import { iconButton } from "./buttons.js";

const TOOL_NAMES: Readonly<Record<Tool, string>> = {
  click: "Click (V)",
  thing: "Thing: what belongs together over the sequence (H)",
  box: "Box (B)",
  lasso: "Lasso (L)",
  polygon: "Polygon (G)",
  brush: "Brush (U), size with [ and ]",
};

export function toolbar(page: Page): HTMLElement {
  return h(
    "div",
    { class: "toolbar", role: "toolbar", "aria-label": "Tools" },
    toolGroup(page),
    labelGroup(page),
    selectionGroup(page),
    historyGroup(page),
  );
}

function group(label: string, ...children: readonly HTMLElement[]): HTMLElement {
  return h("div", { class: "group", role: "group", "aria-label": label }, ...children);
}

function toolGroup({ store, actions }: Page): HTMLElement {
  const buttons = TOOLS.map((tool) => iconButton(tool, TOOL_NAMES[tool], () => actions.select.tool(tool)));
  store.watch(
    ({ tool }) => [tool],
    (tool) => TOOLS.forEach((name, i) => pressed(buttons[i], name === tool)),
  );
  return group("Tools", ...buttons);
}

/** A button that sets a label. */
function labelChip({ actions }: Page, choice: Choice, text: string, key: string, look: string): HTMLButtonElement {
  return h(
    "button",
    {
      class: `chip ${look}`,
      type: "button",
      title: `${text} (${key}): sets the selected; with none selected, every stroke`,
      on: { click: () => actions.select.choose(choice) },
    },
    h("span", { class: "dot" }),
    h("span", { class: "chip-text" }, text),
    h("kbd", {}, key),
  );
}

function labelGroup(page: Page): HTMLElement {
  const { store, actions } = page;
  const plausible = labelChip(page, PLAUSIBLE, "Plausible", "P", "plausible");
  const artifact = labelChip(page, ARTIFACT, "Artifact", "A", "artifact");
  const className = h("span", { class: "chip-text" }, "Class…");
  const classes = h(
    "button",
    {
      class: "chip class",
      type: "button",
      title: "Choose a class (C)",
      on: { click: () => actions.view.dialog("classes") },
    },
    h("span", { class: "dot" }),
    className,
    h("kbd", {}, "C"),
  );
  const machine = labelChip(page, null, "Machine", "M", "machine");
  store.watch(
    ({ armed, labels }) => [armed, labels],
    (armed, labels) => {
      pressed(plausible, armed === PLAUSIBLE);
      pressed(artifact, armed === ARTIFACT);
      pressed(machine, armed === null);
      const named = armed !== undefined && armed !== null && armed !== PLAUSIBLE && armed !== ARTIFACT;
      pressed(classes, named);
      say(className, named ? labels.name(armed) : "Class…");
    },
  );
  return group("Labels", plausible, artifact, classes, machine);
}

function selectionGroup({ store, actions }: Page): HTMLElement {
  const protect = iconButton("protect", "Protect what is corrected already (O)", () => actions.select.toggleProtect());
  const scope = h("button", {
    class: "chip scope",
    type: "button",
    title: "What strokes may change (E)",
    on: { click: () => actions.select.toggleScope() },
  });
  store.watch(
    ({ protect: on, scope: now }) => [on, now],
    (on, now) => {
      pressed(protect, on);
      say(scope, now === "scan" ? "This scan" : "All shown");
      pressed(scope, now === "shown");
    },
  );
  return group(
    "Selection",
    iconButton("flip", "Flip plausible and artifact (X)", () => actions.select.flip()),
    iconButton("invert", "Invert the selection (I)", () => actions.select.invert()),
    protect,
    scope,
  );
}

function historyGroup({ store, actions }: Page): HTMLElement {
  const undo = iconButton("undo", "Undo (Ctrl+Z)", () => void actions.step.undo());
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => void actions.step.redo());
  store.watch(
    ({ history, labels }) => [history, labels],
    (history, labels) => {
      undo.disabled = history.undo === null;
      redo.disabled = history.redo === null;
      const told = (past: typeof history.undo): string => {
        if (past === null) return "";
        if (past.tool === "reviewed") return ": the mark of review";
        if (past.tool === "unreviewed") return ": that a mark of review was taken away";
        return `: ${past.tool}, ${past.changed} to ${labels.choiceName(past.label)}`;
      };
      undo.title = `Undo (Ctrl+Z)${told(history.undo)}`;
      redo.title = `Redo (Ctrl+Shift+Z)${told(history.redo)}`;
    },
  );
  return group("History", undo, redo);
}
