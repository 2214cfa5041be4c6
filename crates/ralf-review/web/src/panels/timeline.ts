/** The radar's scans in time: how much each needs a person, and which are done. */

import type { QueueScan } from "../api/types.js";
import { sameScan } from "../data/scan.js";
import { h } from "../dom.js";
import { decimal, secondsBetween } from "../format.js";
import type { Page } from "../page.js";
import { listed, reasons } from "../queue/queue.js";
import { cleared } from "../viewer/drawing.js";

const OPEN = "#d8b13c";
const DONE = "#2f7d60";
const CORRECTED = "#ffffff";
const CURRENT = "#5eeaa6";
const LEAST_BAR = 3;
const MOST_WIDTH = 18;

export class Timeline {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", { class: "timeline-bars" });
  private rows: readonly QueueScan[] = [];

  constructor(private readonly page: Page) {
    const { store, actions } = page;
    this.element = h(
      "div",
      {
        class: "timeline",
        role: "slider",
        "aria-label": "Scans of this radar in time (arrow keys)",
        "aria-valuemin": "0",
      },
      this.canvas,
    );
    this.element.addEventListener("click", (event) => {
      const row = this.rowAt(event);
      if (row !== undefined) void actions.go.goTo(row);
    });
    this.element.addEventListener("pointermove", (event) => {
      this.element.title = this.describe(this.rowAt(event));
    });
    new ResizeObserver(() => this.draw()).observe(this.element);
    store.watch(
      ({ scans, current }) => [scans, current],
      (scans, current) => {
        this.rows = current === null ? [] : listed(scans, { order: "time", hideReviewed: false, radar: current.radar });
        const at = this.rows.findIndex((row) => sameScan(row, current));
        this.element.setAttribute("aria-valuemax", String(Math.max(this.rows.length - 1, 0)));
        this.element.setAttribute("aria-valuenow", String(Math.max(at, 0)));
        this.element.setAttribute("aria-valuetext", this.describe(this.rows[at]));
        this.draw();
      },
    );
  }

  private describe(row: QueueScan | undefined): string {
    if (row === undefined) return "";
    const at = decimal(secondsBetween(this.rows[0].t_ns, row.t_ns), 2);
    return [
      `${row.radar} ${row.scan}, ${at} s`,
      `${row.expected_errors.toFixed(1)} wrong labels expected`,
      ...reasons(row),
      row.reviewed === null ? "open" : "reviewed",
    ].join(" · ");
  }

  private get step(): number {
    return Math.min(this.element.clientWidth / Math.max(this.rows.length, 1), MOST_WIDTH);
  }

  private rowAt(event: MouseEvent): QueueScan | undefined {
    return this.rows[Math.floor((event.clientX - this.element.getBoundingClientRect().left) / this.step)];
  }

  private draw(): void {
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    const context = cleared(this.canvas, width, height);
    if (context === null) return;
    const { current } = this.page.store.state;
    const { step } = this;
    const gap = step > 4 ? 1 : 0;
    const most = this.rows.reduce((highest, row) => Math.max(highest, row.expected_errors), 1);
    this.rows.forEach((row, i) => {
      const bar = LEAST_BAR + (row.expected_errors / most) * (height - LEAST_BAR - 8);
      if (sameScan(row, current)) {
        context.fillStyle = "rgb(94 234 166 / 18%)";
        context.fillRect(i * step, 0, Math.max(step, 3), height);
      }
      context.fillStyle = sameScan(row, current) ? CURRENT : row.reviewed === null ? OPEN : DONE;
      context.fillRect(i * step, height - bar, Math.max(step - gap, 1), bar);
      context.fillStyle = CORRECTED;
      if (row.corrected > 0) context.fillRect(i * step, height - bar - 4, Math.max(step - gap, 1), 2);
    });
  }
}
