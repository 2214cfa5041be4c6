/** Every key, in one table: what it does, and what `?` says of it. */

import type { Actions } from "../actions/actions.js";
import { ARTIFACT, PLAUSIBLE } from "../data/labels.js";
import { TOOLS } from "../selection/tools.js";
import type { State } from "../state.js";
import type { Store } from "../store.js";

export const GROUPS = ["Correct", "Tools", "Go", "View", "Detections"] as const;

export interface Key {
  /** As `keyName` gives them; the first is shown. */
  readonly keys: readonly string[];
  readonly group: (typeof GROUPS)[number];
  readonly text: string;
  readonly run: () => void;
  /** Whether holding it down does it again and again. What changes labels or marks is done once per press. */
  readonly repeats?: boolean;
}

export interface KeyContext {
  readonly store: Store<State>;
  readonly actions: Actions;
  /** Ends or gives up what the pointer is doing. */
  readonly cancelGesture: () => boolean;
  readonly closePolygon: () => boolean;
  readonly home: () => void;
  readonly seenCamera: () => string | null;
}

export function keyTable(context: KeyContext): readonly Key[] {
  return [...correct(context), ...tools(context), ...go(context), ...view(context), ...detections(context)];
}

function correct({ actions, cancelGesture }: KeyContext): readonly Key[] {
  const { select, step, review, settle, view: viewing } = actions;
  const key = (keys: readonly string[], text: string, run: () => void): Key => ({ keys, group: "Correct", text, run });
  return [
    key(["p", "1"], "Selected are plausible; with none selected: every stroke sets plausible", () =>
      select.choose(PLAUSIBLE),
    ),
    key(["a", "2"], "Selected are artifacts", () => select.choose(ARTIFACT)),
    key(["c", "3"], "Choose a class", () => viewing.dialog("classes")),
    key(["5"], "Where two people differ: the first is right", () => settle.take("first")),
    key(["6"], "Where two people differ: the second is right", () => settle.take("second")),
    key(["m", "4", "backspace"], "Back to the machine's guess", () => select.choose(null)),
    key(["x"], "Flip: plausible becomes artifact and the other way round", () => select.flip()),
    key(["i"], "Invert the selection", () => select.invert()),
    key(["ctrl+a"], "Select everything that may be changed", () => select.all()),
    key(
      ["escape"],
      "Give up the gesture, the selection, the painting",
      () => void (cancelGesture() || select.escape()),
    ),
    key(["ctrl+z"], "Undo: your own last stroke or mark", () => void step.undo()),
    key(["ctrl+shift+z", "ctrl+y"], "Redo", () => void step.redo()),
    key(["r"], "Mark the scan as reviewed, or take the mark back", () => review.toggle()),
    key(["o"], "Protect what is corrected already", () => select.toggleProtect()),
    key(["e"], "Correct this scan alone, or everything shown", () => select.toggleScope()),
  ];
}

function tools({ actions, closePolygon }: KeyContext): readonly Key[] {
  const { select } = actions;
  const key = (keys: readonly string[], text: string, run: () => void): Key => ({ keys, group: "Tools", text, run });
  const letters = ["v", "h", "b", "l", "g", "u"];
  const names = [
    "Click; drag moves the view",
    "Thing: all that belongs together over the sequence",
    "Box",
    "Lasso",
    "Polygon",
    "Brush",
  ];
  return [
    ...TOOLS.map((tool, i) => key([letters[i]], names[i], () => select.tool(tool))),
    repeating(key(["d"], "Choose the next detection, from left to right", () => actions.pick.step(1))),
    repeating(key(["shift+d"], "Choose the detection before", () => actions.pick.step(-1))),
    repeating(key(["["], "Smaller brush; fewer of a kind", () => select.brush(-1))),
    repeating(key(["]"], "Larger brush; more of a kind", () => select.brush(1))),
    key([" "], "Close the polygon", () => void closePolygon()),
  ];
}

function go({ actions }: KeyContext): readonly Key[] {
  const { go: going, review } = actions;
  const key = (keys: readonly string[], text: string, run: () => void): Key => ({ keys, group: "Go", text, run });
  return [
    key(["n"], "To the next scan that needs a person", () => void going.nextNeedy()),
    key(
      ["shift+n"],
      "To the next doubtful thing; P, A or a class answer it and go on",
      () => void actions.thing.next(),
    ),
    key(
      ["shift+r"],
      "Relabel with what you said: a proposal; again accepts it, Esc drops it",
      () => void actions.opine.askOrAccept(),
    ),
    key(
      ["shift+g"],
      "To the next kind of detections that are probably wrong; P, A or a class answer all of it, again leaves it",
      () => void actions.kind.next(),
    ),
    key(["shift+s"], "To the next detections that two people labelled differently", () => void actions.settle.next()),
    key(["shift+t"], "The team: who has done how much, and how far people agree", () => void actions.settle.open()),
    key(["z"], "The whole sequence at once, or this scan alone", () => void going.toggleWhole()),
    key(["enter"], "Mark as reviewed and go to the next needy scan", () => review.accept(true)),
    repeating(key(["arrowright"], "To the radar's next scan", () => void going.step(1))),
    repeating(key(["arrowleft"], "To the radar's previous scan", () => void going.step(-1))),
    key(["shift+arrowright"], "Play: from scan to scan, until pressed again", () => void going.play()),
    repeating(key(["arrowdown"], "To the next scan of the list", () => void going.stepInList(1))),
    repeating(key(["arrowup"], "To the previous scan of the list", () => void going.stepInList(-1))),
    key(["s"], "To the next radar at this moment", () => void going.nextRadar()),
  ];
}

function view({ actions, home, seenCamera }: KeyContext): readonly Key[] {
  const { view: viewing, go: going } = actions;
  const key = (keys: readonly string[], text: string, run: () => void): Key => ({ keys, group: "View", text, run });
  return [
    key(["t"], "Bird's eye or free 3D view", () => viewing.toggleMode()),
    key(["f"], "The whole scan", home),
    key(["w"], "The camera in the centre, or the scene", () => viewing.toggleCameraMode()),
    key(["q"], "Next camera", () => viewing.nextCamera(seenCamera())),
    key(["."], "Accumulate one more scan before and after", () => void going.accumulate(1)),
    key([","], "Accumulate one fewer", () => void going.accumulate(-1)),
    key(["k"], "LiDAR on or off", () => viewing.toggleLidar()),
    key(["shift+k"], "LiDAR in the cameras' images, or not", () => viewing.toggleLidarInImages()),
    key(["j"], "LiDAR's ground on or off", () => viewing.toggleGround()),
    key(["shift+h"], "Hold what is selected still over the scans, or let it go", () => actions.hold.toggle()),
    key(["shift+l"], "Light or dark background", () => viewing.toggleLight()),
    key(["?"], "This list", () => viewing.dialog("help")),
  ];
}

function detections({ store, actions }: KeyContext): readonly Key[] {
  const { view: viewing } = actions;
  const key = (keys: readonly string[], text: string, run: () => void): Key => ({
    keys,
    group: "Detections",
    text,
    run,
  });
  return [
    key(["y"], "Next way of colouring", () => viewing.nextColour(1)),
    key(["shift+y"], "Previous way of colouring", () => viewing.nextColour(-1)),
    repeating(key(["+", "="], "Larger dots", () => viewing.dots(1))),
    repeating(key(["-"], "Smaller dots", () => viewing.dots(-1))),
    key(["shift+p"], "Show or hide plausible ones", () => viewing.filter({ plausible: !store.state.filter.plausible })),
    key(["shift+a"], "Show or hide artifacts", () => viewing.filter({ artifact: !store.state.filter.artifact })),
    key(["shift+u"], "Only uncertain ones", () => viewing.filter({ uncertain: !store.state.filter.uncertain })),
    key(["0"], "Show everything", () => viewing.showEverything()),
  ];
}

function repeating(key: Key): Key {
  return { ...key, repeats: true };
}

type Pressed = Pick<KeyboardEvent, "key" | "code" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey">;

/** What a key writes; where that is a letter of another script, the letter that lies there on a Latin keyboard. */
function latin({ key, code }: Pressed): string {
  const isOther = key.length === 1 && /\p{Letter}/u.test(key) && !/\p{Script=Latin}/u.test(key);
  return (isOther ? /^Key([A-Z])$/.exec(code)?.[1] : undefined) ?? key;
}

/** How a pressed key is called: modifiers, then the key in lower case; a sign's shift is part of the sign. */
export function keyName(event: Pressed): string {
  const name = latin(event).toLowerCase();
  const sign = name.length === 1 && !/[a-z]/.test(name);
  const modifiers = [
    event.ctrlKey || event.metaKey ? "ctrl+" : "",
    event.altKey ? "alt+" : "",
    event.shiftKey && !sign ? "shift+" : "",
  ];
  return modifiers.join("") + name;
}

const SHOWN: Readonly<Record<string, string>> = {
  arrowleft: "←",
  arrowright: "→",
  arrowup: "↑",
  arrowdown: "↓",
  escape: "Esc",
  enter: "Enter",
  backspace: "⌫",
  " ": "Space",
  "-": "−",
};

/** The parts of a key as they are printed on it. */
export function shownKey(name: string): readonly string[] {
  const parts = name === "+" ? ["+"] : name.split("+");
  return parts.map(
    (part) => SHOWN[part] ?? (part.length === 1 ? part.toUpperCase() : part[0].toUpperCase() + part.slice(1)),
  );
}

export function listenToKeys(table: readonly Key[], store: Store<State>): void {
  const byName = new Map(table.flatMap((key) => key.keys.map((name) => [name, key] as const)));
  document.addEventListener("keydown", (event) => {
    const { dialog, outbox } = store.state;
    if (dialog !== "none" || outbox.kind === "conflict" || typing(event)) return;
    const name = keyName(event);
    if ((name === "enter" || name === " ") && pressable(event.target)) {
      // Held down, it would be pressed again and again.
      if (event.repeat) event.preventDefault();
      return;
    }
    const key = byName.get(name);
    if (key === undefined) return;
    event.preventDefault();
    if (!event.repeat || key.repeats === true) key.run();
  });
}

/** Buttons, and headings that open and close, are pressed by keys of their own. */
function pressable(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest("button, summary") !== null;
}

/** A slider's own keys. */
const SLIDING = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown"];

function typing({ target, key }: KeyboardEvent): boolean {
  if (target instanceof HTMLInputElement && target.type === "range") return SLIDING.includes(key);
  return (
    target instanceof HTMLInputElement || target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement
  );
}
