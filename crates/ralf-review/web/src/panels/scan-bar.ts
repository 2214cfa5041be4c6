/** Over the picture: how the scene is shown, which scan it is, and the mark of review. */

import type { Page } from "../page.js";
import { h, pressed, say, select, setOptions } from "../dom.js";
import { counted, decimal, secondsBetween } from "../format.js";
import { icon } from "../icons.js";
import type { ViewMode } from "../state.js";
import { colourModes } from "../viewer/colours.js";
import { iconButton } from "./buttons.js";

const MODES: readonly (readonly [ViewMode, string, string])[] = [
  ["bird", "Bird's eye", "T"],
  ["free", "3D", "T"],
  ["camera", "Camera", "W"],
];

export function scanBar(page: Page): HTMLElement {
  return h("div", { class: "scan-bar" }, modes(page), colouring(page), accumulation(page), lidar(page), review(page));
}

/** Which scan this is; stands in the picture's corner. */
export function scanTitle({ store }: Page): HTMLElement {
  const name = h("strong");
  const facts = h("span", { class: "faint" });
  store.watch(
    ({ cloud, loading, current, recording, sequence }) => [cloud, loading, current, recording, sequence],
    (cloud, loading, current, recording, sequence) => {
      say(name, current === null ? "No scans" : `${current.radar} · ${current.scan}`);
      const scan = cloud.scans[0];
      const radars = recording.sequences.find((other) => other.name === sequence)?.radars ?? [];
      const [first] = radars.flatMap(({ scans }) => scans.slice(0, 1)).sort((a, b) => Number(BigInt(a) - BigInt(b)));
      if (loading || scan === undefined || first === undefined) return say(facts, loading ? "loading…" : "");
      const { t_ns: time } = scan.table.header;
      const blurred = cloud.compensated ? "" : "no odometry: scans are not moved together · ";
      return say(
        facts,
        `${blurred}${decimal(secondsBetween(first, time), 2)} s · ${counted(scan.table.rows, "detection")}`,
      );
    },
  );
  return h("div", { class: "scan-title", "aria-live": "polite" }, name, facts);
}

function modes({ store, actions }: Page): HTMLElement {
  const buttons = MODES.map(([mode, text, key]) =>
    h(
      "button",
      { class: "segment", type: "button", title: `${text} (${key})`, on: { click: () => actions.view.mode(mode) } },
      text,
    ),
  );
  store.watch(
    ({ mode, cameras }) => [mode, cameras.length],
    (mode, count) => {
      MODES.forEach(([name], i) => pressed(buttons[i], name === mode));
      buttons[2].disabled = count === 0;
    },
  );
  return h("div", { class: "segments", role: "group", "aria-label": "View" }, ...buttons);
}

function colouring({ store, actions }: Page): HTMLElement {
  const list = select("Colour by (Y)", [], (value) => actions.view.colour(value));
  let listed = "";
  store.watch(
    ({ colour, cloud, recording }) => [colour, cloud.scans, recording],
    (colour) => {
      const options = colourModes(store.state.cloud, store.state.recording);
      const now = options.map(({ value }) => value).join();
      if (now !== listed) setOptions(list, options);
      listed = now;
      list.value = options.some(({ value }) => value === colour) ? colour : "label";
    },
  );
  return h("label", { class: "field", title: "Colour by (Y)" }, h("span", { class: "field-name" }, "Colour"), list);
}

function accumulation({ store, actions }: Page): HTMLElement {
  const value = h("output", { class: "number" });
  const button = (text: string, label: string, by: number): HTMLButtonElement =>
    h(
      "button",
      {
        class: "step",
        type: "button",
        "aria-label": label,
        title: label,
        on: { click: () => void actions.go.accumulate(by) },
      },
      text,
    );
  store.watch(
    ({ accumulate }) => [accumulate],
    (accumulate) => say(value, accumulate === 0 ? "off" : `±${accumulate}`),
  );
  return h(
    "div",
    { class: "field stepper", role: "group", "aria-label": "Accumulated scans before and after" },
    h("span", { class: "field-name" }, "Scans"),
    button("−", "Accumulate fewer (,)", -1),
    value,
    button("+", "Accumulate more (.)", 1),
  );
}

function lidar({ store, actions }: Page): HTMLElement {
  const points = iconButton("lidar", "LiDAR (K)", () => actions.view.toggleLidar());
  const ground = iconButton("ground", "LiDAR's ground (J)", () => actions.view.toggleGround());
  store.watch(
    ({ lidarShown, groundHidden }) => [lidarShown, groundHidden],
    (shown, hidden) => {
      pressed(points, shown);
      pressed(ground, !hidden);
    },
  );
  return h("div", { class: "group", role: "group", "aria-label": "LiDAR" }, points, ground);
}

function review({ store, actions }: Page): HTMLElement {
  const text = h("span");
  const mark = h(
    "button",
    {
      class: "review",
      type: "button",
      title: "Mark as reviewed (R); with Enter, go on to the next",
      on: {
        click: () => actions.review.toggle(),
      },
    },
    icon("check"),
    text,
  );
  const next = iconButton("next", "Next scan that needs a person (N)", () => void actions.go.nextNeedy());
  store.watch(
    ({ cloud }) => [cloud.scans[0]?.reviewed ?? null],
    (reviewed) => {
      pressed(mark, reviewed !== null);
      say(text, reviewed === null ? "Mark reviewed" : `Reviewed by ${reviewed.author}`);
    },
  );
  return h("div", { class: "group last" }, mark, next);
}
