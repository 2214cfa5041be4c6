/** The left panel: sequence, progress, and the scans in the order in which they need a person. */

import type { QueueScan } from "../api/types.js";
import { sameScan } from "../data/scan.js";
import { childrenOf, h, pressed, say, select, setOptions } from "../dom.js";
import { counted, shortName } from "../format.js";
import type { Page } from "../page.js";
import { listed, type QueueOrder, reasons } from "../queue/queue.js";

const ROW = 54;
/** Rows drawn above and below what is seen, so that scrolling shows no gaps. */
const SPARE = 6;

/** A scan and its place in the list. */
interface Row {
  readonly entry: QueueScan;
  readonly place: number;
}

export class QueuePanel {
  readonly element: HTMLElement;
  private readonly list = h("div", { class: "queue-list", role: "listbox", "aria-label": "Scans", tabindex: "0" });
  private readonly room = h("div", { class: "queue-room" });
  private rows: readonly QueueScan[] = [];
  private readonly put = childrenOf<Row>(
    this.room,
    ({ entry: { radar, scan } }) => `${radar}/${scan}`,
    ({ entry: { radar, scan } }) => {
      const open = (): void => void this.page.actions.go.goTo({ radar, scan });
      return h("div", { role: "option", on: { click: open } });
    },
    (row, item) => this.show(row, item),
  );
  /** The most errors that are expected of any scan. */
  private most = 1;

  constructor(private readonly page: Page) {
    this.list.append(this.room);
    this.element = h("section", { class: "queue", "aria-label": "Queue" }, head(page), order(page), this.list);
    this.list.addEventListener("scroll", () => this.draw());
    let height = 0;
    new ResizeObserver(() => {
      // A list that was hidden could not be scrolled to the scan.
      if (height === 0) this.reveal();
      else this.draw();
      height = this.list.clientHeight;
    }).observe(this.list);
    const { store } = page;
    store.watch(
      ({ scans, queueView }) => [scans, queueView],
      (scans, view) => {
        this.rows = listed(scans, view);
        this.most = scans.reduce((most, { expected_errors: errors }) => Math.max(most, errors), 1);
        this.room.style.setProperty("height", `${this.rows.length * ROW}px`);
        this.draw();
      },
    );
    store.watch(
      ({ current }) => [current],
      () => this.reveal(),
    );
  }

  private reveal(): void {
    const at = this.rows.findIndex((entry) => sameScan(entry, this.page.store.state.current));
    const [top, height] = [at * ROW, this.list.clientHeight];
    if (at >= 0 && (top < this.list.scrollTop || top + ROW > this.list.scrollTop + height)) {
      this.list.scrollTop = Math.max(top - height / 2, 0);
    }
    this.draw();
  }

  private draw(): void {
    const first = Math.max(Math.floor(this.list.scrollTop / ROW) - SPARE, 0);
    const last = Math.ceil((this.list.scrollTop + this.list.clientHeight) / ROW) + SPARE;
    this.put(this.rows.slice(first, last).map((entry, i) => ({ entry, place: first + i })));
  }

  private show(row: HTMLElement, { entry, place }: Row): void {
    row.className = entry.reviewed === null ? "queue-row" : "queue-row done";
    row.setAttribute("aria-selected", String(sameScan(entry, this.page.store.state.current)));
    row.title = tooltip(entry);
    row.style.setProperty("top", `${place * ROW}px`);
    const bar = h("span", { class: "need-bar" }, h("span"));
    (bar.firstElementChild as HTMLElement).style.setProperty(
      "width",
      `${Math.round((100 * entry.expected_errors) / this.most)}%`,
    );
    row.replaceChildren(
      h(
        "span",
        { class: "queue-name" },
        h("span", {}, shortName(entry.radar)),
        h("b", { class: "number" }, String(entry.scan)),
      ),
      h("span", { class: "queue-need" }, bar, h("b", { class: "number" }, entry.expected_errors.toFixed(1))),
      h("span", { class: "queue-reasons" }, ...said(entry)),
    );
  }
}

function said(entry: QueueScan): HTMLElement[] {
  const parts = reasons(entry).map((reason) =>
    h("span", { class: reason.includes("failed") ? "reason alarm" : "reason" }, reason),
  );
  if (entry.orphaned > 0) parts.push(h("span", { class: "reason alarm" }, `${entry.orphaned} orphaned`));
  if (entry.corrected > 0) parts.unshift(h("span", { class: "reason corrected" }, `${entry.corrected} corrected`));
  if (entry.reviewed !== null) parts.unshift(h("span", { class: "reason reviewed" }, "✓ reviewed"));
  return parts;
}

function tooltip({ detections, reviewed, orphaned, expected_errors: errors }: QueueScan): string {
  const by = reviewed === null ? "" : `, reviewed by ${reviewed.author}`;
  const lost = orphaned === 0 ? "" : `; orphaned are corrections of other detections: kept, not applied`;
  return `${counted(detections, "detection")}, ${errors.toFixed(1)} expected to be wrong${by}${lost}`;
}

/** The list of sequences; how far each is stands there once somebody looks into it. */
function sequenceList({ store, actions }: Page): HTMLElement {
  const list = select("Sequence", [], (name) => {
    void actions.go.open(name).then(() => (list.value = store.state.sequence));
  });
  list.addEventListener("focus", () => void actions.go.readProgress());
  store.watch(
    ({ recording }) => [recording],
    ({ sequences }) =>
      setOptions(
        list,
        sequences.map(({ name }) => ({ value: name, text: name })),
      ),
  );
  store.watch(
    ({ recording, sequence, progress, progressElsewhere }) => [recording, sequence, progress, progressElsewhere],
    ({ sequences }, sequence, progress, elsewhere) => {
      sequences.forEach(({ name, title, labelled, assigned }, i) => {
        const known = name === sequence ? progress : elsewhere.get(name);
        const done = known === undefined ? "" : ` · ${known.reviewed}/${known.scans}`;
        const whose = assigned === null ? "" : ` · ${assigned}`;
        list.options[i].text =
          `${name}${title === "" ? "" : ` · ${title}`}${whose}${labelled ? done : " (not labelled)"}`;
      });
      list.value = sequence;
    },
  );
  return list;
}

function head({ store, actions }: Page): HTMLElement {
  const bar = h(
    "span",
    { class: "progress-bar", role: "progressbar", "aria-label": "Reviewed scans", "aria-valuemin": "0" },
    h("span"),
  );
  const text = h("span", { class: "faint number" });
  store.watch(
    ({ progress }) => [progress],
    ({ scans, reviewed, corrected_detections: corrected }) => {
      (bar.firstElementChild as HTMLElement).style.setProperty(
        "width",
        `${scans === 0 ? 0 : (100 * reviewed) / scans}%`,
      );
      bar.setAttribute("aria-valuemax", String(scans));
      bar.setAttribute("aria-valuenow", String(reviewed));
      say(text, `${reviewed} of ${scans.toLocaleString("en")} reviewed · ${corrected.toLocaleString("en")} corrected`);
    },
  );
  const { dataset, out } = store.state.recording;
  const brand = h(
    "h1",
    { class: "brand", title: `${dataset}, labels in ${out}` },
    h("strong", {}, "RALF"),
    h("span", {}, "review"),
    h("span", { class: "faint" }, `${dataset} · ${out}`),
  );
  return h("header", { class: "queue-head" }, brand, sequenceList({ store, actions }), bar, text);
}

/** Whose scans are listed. */
function radarList({ store, actions }: Page): HTMLSelectElement {
  const radars = select("Radar", [], (value) => actions.go.viewQueue({ radar: value === "" ? null : value }));
  store.watch(
    ({ recording, sequence }) => [recording, sequence],
    (recording, sequence) => {
      const names = recording.sequences.find(({ name }) => name === sequence)?.radars.map(({ name }) => name) ?? [];
      setOptions(radars, [{ value: "", text: "All radars" }, ...names.map((name) => ({ value: name, text: name }))]);
      radars.value = store.state.queueView.radar ?? "";
    },
  );
  return radars;
}

function order({ store, actions }: Page): HTMLElement {
  const orders: readonly (readonly [QueueOrder, string])[] = [
    ["need", "Need"],
    ["time", "Time"],
  ];
  const buttons = orders.map(([name, text]) =>
    h("button", { class: "segment", type: "button", on: { click: () => actions.go.viewQueue({ order: name }) } }, text),
  );
  const open = h(
    "button",
    {
      class: "segment",
      type: "button",
      title: "Hide what is reviewed",
      on: {
        click: () => actions.go.viewQueue({ hideReviewed: !store.state.queueView.hideReviewed }),
      },
    },
    "Open",
  );
  const radars = radarList({ store, actions });
  store.watch(
    ({ queueView }) => [queueView],
    ({ order: now, hideReviewed, radar }) => {
      orders.forEach(([name], i) => pressed(buttons[i], name === now));
      pressed(open, hideReviewed);
      radars.value = radar ?? "";
    },
  );
  const things = h(
    "button",
    {
      class: "segment",
      type: "button",
      title: "To the next doubtful thing (Shift N)",
      on: { click: () => void actions.thing.next() },
    },
    "Things",
  );
  store.watch(
    ({ thing }) => [thing],
    (thing) => pressed(things, thing !== null),
  );
  return h(
    "div",
    { class: "queue-order" },
    h("div", { class: "segments", role: "group", "aria-label": "Order" }, ...buttons, open, things),
    radars,
  );
}
