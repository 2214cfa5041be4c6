/** Who has done how much, how far people agree, and the way to where they don't. */

import type { Agreement, Disagreements } from "../api/types.js";
import { comparedScans, peopleOf, perHour, type Person } from "../data/team.js";
import { h } from "../dom.js";
import { counted, decimal } from "../format.js";
import type { Page } from "../page.js";
import { keyButton } from "./buttons.js";
import { openWith } from "./dialog.js";
import { firstOf } from "./settle-bar.js";

export function teamDialog(page: Page): HTMLDialogElement {
  const { store, actions } = page;
  const body = h("div", { class: "team-body" });
  const next = keyButton("Next disagreement", "Shift S", () => void actions.settle.next());
  const close = keyButton("Close", "", () => actions.view.dialog("none"));
  const head = h("header", {}, h("h2", {}, "Team"), h("div", { class: "row" }, next, close));
  const dialog = h("dialog", { class: "help team", "aria-label": "Team" }, head, body);
  openWith(page, dialog, "team");
  store.watch(
    ({ workdays, disagreements }) => [workdays, disagreements],
    (workdays, disagreements) => {
      next.hidden = (disagreements?.changes.length ?? 0) === 0;
      const agreed = disagreements === null ? [] : agreements(disagreements, firstOf(store.state));
      body.replaceChildren(...agreed, ...done(peopleOf(workdays)));
    },
  );
  return dialog;
}

function agreements({ people, waiting, changes }: Disagreements, first: string): readonly HTMLElement[] {
  const wait = waiting === null || waiting === 0 ? "" : `, ${counted(waiting, "scan")} wait for one of both`;
  const told = "Only scans that both are through with are told.";
  const left = h(
    "p",
    { class: "faint" },
    `${counted(changes.length, "disagreement")} to settle in this sequence${wait}. ${told}`,
  );
  return [h("h3", {}, "Labelled twice, neither seeing the other's"), left, ...people.map((one) => agreed(one, first))];
}

/** Kappa first of all, then by radar and by label. */
function agreed(told: Agreement, first: string): HTMLElement {
  const { overall, radars, classes } = told.agreement;
  const rows = [["plausible or not", overall] as const, ...Object.entries(radars)].map(([name, counts]) => [
    name,
    whole(counts.labelled_by_both),
    whole(counts.disagree),
    decimal2(counts.kappa),
  ]);
  const labels = Object.entries(classes).map(([name, { both, first_alone, second_alone, kappa }]) => [
    name,
    whole(both + first_alone + second_alone),
    whole(first_alone + second_alone),
    decimal2(kappa),
  ]);
  const kappa = h("strong", { class: "kappa" }, `κ ${decimal2(overall.kappa)}`);
  const title = h("p", {}, kappa, ` ${comparedScans(first, told)}`);
  return h("div", {}, title, table(["", "detections", "differ", "κ"], [...rows, ...labels]));
}

function done(people: readonly Person[]): readonly HTMLElement[] {
  const head = ["", "detections", "scans", "days", "hours", "detections/h", "scans/h"];
  const rows = people.map(({ name, second, detections, scans, days, hours }) => [
    second ? `${name} (second)` : name,
    whole(detections),
    whole(scans),
    whole(days),
    decimal(hours, 1),
    decimal(perHour(detections, hours), 0),
    decimal(perHour(scans, hours), 0),
  ]);
  const note = "All sequences; time between edits no more than five minutes apart.";
  return [h("h3", {}, "Corrected and reviewed"), table(head, rows), h("p", { class: "faint" }, note)];
}

function table(head: readonly string[], rows: readonly (readonly string[])[]): HTMLElement {
  const cells = (row: readonly string[]): HTMLElement[] =>
    row.map((text, i) => (i === 0 ? h("th", { scope: "row" }, text) : h("td", { class: "number" }, text)));
  return h(
    "table",
    {},
    h("thead", {}, h("tr", {}, ...head.map((text) => (text === "" ? h("td") : h("th", { scope: "col" }, text))))),
    h("tbody", {}, ...rows.map((row) => h("tr", {}, ...cells(row)))),
  );
}

function whole(count: number): string {
  return count.toLocaleString("en");
}

function decimal2(value: number | null): string {
  return decimal(value ?? Number.NaN, 2);
}
