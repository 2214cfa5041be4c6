// The program, a browser, and what tests ask of them.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { once } from "node:events";
import { cp, mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";

const { RALF_PROGRAM, RALF_DATASET, RALF_OUT, RALF_PLANTED, RALF_CHROMIUM } = process.env;

/** Detections whose label in OUT is wrong: {radar, scan, point, label} with the right label. */
export const planted = JSON.parse(await readFile(RALF_PLANTED, "utf8"));

const CHROMIUM = [
  "--no-sandbox",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  // Without a graphics card, what only looks like one draws text and boxes, and puts them together, more slowly than the
  // processor itself.
  "--disable-gpu-rasterization",
  "--disable-gpu-compositing",
];
/** What Chromium then says of itself: the picture is read back. */
const READ_BACK = /GPU stall due to ReadPixels/;

/** Where a machine is shared and draws without a graphics card, a frame may take a second. */
const PATIENCE_MS = 60_000;

/** Sees the page as a person would: RALF_PICTURES names a folder for pictures of it. */
export async function picture(page, name) {
  if (process.env.RALF_PICTURES) await page.screenshot({ path: `${process.env.RALF_PICTURES}/${name}.png` });
}

export function launch(...more) {
  return chromium.launch({ executablePath: RALF_CHROMIUM, args: [...CHROMIUM, ...more] });
}

/** Runs the program to its end. */
export function ralf(...commands) {
  const ran = spawnSync(RALF_PROGRAM, commands, { encoding: "utf8" });
  assert.equal(ran.status, 0, ran.stderr);
}

/** A folder that is gone when the test has ended. */
export async function freshFolder(context) {
  const folder = await mkdtemp(join(tmpdir(), "ralf-review-"));
  atEnd(context, () => rm(folder, { recursive: true, force: true }));
  return folder;
}

const endings = new WeakMap();

/** Does this when the test ends, what was begun last first: no page may ask a server whose files are gone. */
export function atEnd(context, action) {
  const before = endings.get(context);
  if (before) return void before.push(action);
  const actions = [action];
  endings.set(context, actions);
  context.after(async () => {
    while (actions.length > 0) await actions.pop()();
  });
}

/** A copy of the labels, so that every test begins with none corrected. */
export async function freshOut(context) {
  const folder = await freshFolder(context);
  await cp(RALF_OUT, join(folder, "out"), { recursive: true });
  return join(folder, "out");
}

/** `ralf review`, until the test ends or `kill` is called. */
export async function serve(context, out, { author = "ada", second, port = 0, dataset = RALF_DATASET } = {}) {
  const who = second === undefined ? ["--author", author] : ["--second", second];
  const child = spawn(RALF_PROGRAM, ["review", dataset, out, "--port", String(port), ...who], {
    stdio: ["ignore", "pipe", "inherit"],
    env: { ...process.env, XDG_STATE_HOME: join(out, "..", "state") },
  });
  const kill = async (signal = "SIGKILL") => {
    if (child.exitCode !== null || child.signalCode !== null) return;
    child.kill(signal);
    await once(child, "exit");
  };
  atEnd(context, () => kill());
  const lines = createInterface({ input: child.stdout });
  const [line] = await once(lines, "line");
  const url = line.match(/http:\/\/\S+/)[0];
  const address = new URL(url);
  return { url, port: Number(address.port), token: address.searchParams.get("token"), kill };
}

/** A browser of its own: another person. */
export async function anotherBrowser(context, browser, viewport = { width: 1280, height: 800 }) {
  const own = await browser.newContext({ viewport });
  own.setDefaultTimeout(PATIENCE_MS);
  atEnd(context, async () => {
    // A request that a test answers itself may be under way.
    for (const page of own.pages()) await page.unrouteAll({ behavior: "ignoreErrors" });
    await own.close();
  });
  return own;
}

/**
 * A page on the server; `complaints` are console errors, `strangers` are requests to anywhere else, `pending` those that
 * are not answered yet, but for the one that waits for news.
 */
export async function open(context, browser, server, own) {
  const page = await (own ?? (await anotherBrowser(context, browser))).newPage();
  const told = { page, complaints: [], strangers: [], pending: new Set() };
  const { origin } = new URL(server.url);
  page.on("console", (message) => {
    if (READ_BACK.test(message.text())) return;
    if (message.type() === "error" || message.type() === "warning") told.complaints.push(message.text());
  });
  page.on("pageerror", (error) => told.complaints.push(String(error)));
  page.on("request", (request) => {
    const { protocol, origin: asked } = new URL(request.url());
    if (protocol !== "blob:" && asked !== origin) told.strangers.push(request.url());
    if (!request.url().includes("/changes")) told.pending.add(request);
  });
  for (const end of ["requestfinished", "requestfailed"]) page.on(end, (request) => told.pending.delete(request));
  await page.goto(server.url);
  await ready(page);
  return told;
}

/** A page of its own on labels of which none is corrected; with a viewport, in a window of that size. */
export async function opened(context, browser, viewport) {
  const server = await serve(context, await freshOut(context));
  const tab = await open(context, browser, server, await anotherBrowser(context, browser, viewport));
  return { server, tab, page: tab.page };
}

/** Waits until a scan is on screen. */
export async function ready(page) {
  await page.waitForFunction(() =>
    / detections?$/.test(document.querySelector(".scan-title .faint")?.textContent ?? ""),
  );
}

/** Waits until the page has asked for nothing for a while. */
export async function settled({ page, pending }) {
  for (let quiet = 0; quiet < 10; quiet = pending.size === 0 ? quiet + 1 : 0) await page.waitForTimeout(30);
}

/** What Chromium itself logs while nobody answers, or of an answer 409. */
export const GONE = /ERR_CONNECTION|ERR_EMPTY_RESPONSE|ERR_SOCKET|net::ERR/;
export const REFUSED = /status of 409/;

export function clean({ complaints, strangers }, expected = /$^/) {
  assert.deepEqual(
    complaints.filter((text) => !expected.test(text)),
    [],
  );
  assert.deepEqual(strangers, []);
}

/** Asks the server, as anybody or as the person in a page's browser. */
export async function ask(server, path, author = null) {
  const headers = { Authorization: `Bearer ${server.token}`, ...(author === null ? {} : { "X-Ralf-Author": author }) };
  const answer = await fetch(new URL(`/api/${path}`, server.url), { headers });
  assert.equal(answer.status, 200, path);
  return answer;
}

export async function sequenceOf(server) {
  const recording = await (await ask(server, "recording")).json();
  return recording.sequences[0].name;
}

const ARRAYS = { f32: Float32Array, u8: Uint8Array, u16: Uint16Array, i32: Int32Array, u32: Uint32Array };

/** The labels as `ralf export` hands them on: by "radar/scan", SemanticKITTI ids. */
export async function exported(out) {
  const folder = join(out, "..", "kitti");
  ralf("export", RALF_DATASET, out, "--to", "semantickitti", "-o", folder);
  const [, ...lines] = (await readFile(join(folder, "sequences.csv"), "utf8")).trim().split("\n");
  const labels = new Map();
  for (const [number, , radar, scans] of lines.map((line) => line.split(","))) {
    for (let scan = 0; scan < Number(scans); scan += 1) {
      const file = await readFile(
        join(folder, "sequences", number, "labels", `${String(scan).padStart(6, "0")}.label`),
      );
      const ids = Array.from({ length: file.length / 4 }, (_, i) => file.readUInt32LE(4 * i) & 0xffff);
      labels.set(`${radar}/${scan}`, ids);
    }
  }
  return labels;
}

/** A scan as the server has it: {header, x, y, label, ...}. */
export function scanOf(server, { radar, scan }) {
  return tableOf(server, `radars/${radar}/scans/${scan}`);
}

/** A table of the sequence as the server has it: {header, and each column by its name}. */
export async function tableOf(server, what) {
  const buffer = await (await ask(server, `sequences/${await sequenceOf(server)}/${what}`)).arrayBuffer();
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const columns = header.columns.map(({ name, type, offset }) => [
    name,
    new ARRAYS[type](buffer, 4 + length + offset, header.rows),
  ]);
  return { header, ...Object.fromEntries(columns) };
}

/** What the person in a page's browser can undo and redo. */
export async function historyOf(server, page) {
  const author = await page.evaluate(() => localStorage.getItem("ralf-author"));
  return (await ask(server, `sequences/${await sequenceOf(server)}/history`, author)).json();
}

/** Presses Enter until the scan is accepted: detections that were never on screen are asked for first. */
export async function accept(page) {
  await page.keyboard.press("Enter");
  if (await page.locator(".accept").isVisible()) await page.keyboard.press("Enter");
}

export async function queueOf(server) {
  return (await ask(server, `sequences/${await sequenceOf(server)}/queue`)).json();
}

/** The scan on screen. */
export async function current(page) {
  const parts = decodeURIComponent(new URL(page.url()).hash.slice(1)).split("/");
  return { radar: parts[1], scan: Number(parts[2]) };
}

/** Pixels of the window at which the bird's eye shows a place of the vehicle frame, m. */
export async function pixel(page, x, y) {
  const viewport = page.locator(".viewport");
  const [box, target, metres] = await Promise.all([
    viewport.boundingBox(),
    viewport.getAttribute("data-target"),
    viewport.getAttribute("data-metres-per-pixel"),
  ]);
  const [centreX, centreY] = target.split(" ").map(Number);
  return [box.x + box.width / 2 - (y - centreY) / metres, box.y + box.height / 2 - (x - centreX) / metres];
}

/** Draws with the left button held along places of the window. */
export async function drag(page, places) {
  await page.mouse.move(...places[0]);
  await page.mouse.down();
  for (const place of places.slice(1)) await page.mouse.move(...place, { steps: 4 });
  await page.mouse.up();
}

/** A lasso around everything on screen, leaving the frame's edge alone. */
export async function lassoAll(page) {
  const box = await page.locator(".viewport").boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await page.keyboard.press("l");
  await drag(page, [at(0.05, 0.05), at(0.95, 0.05), at(0.95, 0.95), at(0.05, 0.95)]);
}

export function status(page) {
  return page.locator(".saved");
}

export async function says(locator, text) {
  try {
    await locator.filter({ hasText: text }).waitFor();
  } catch (cause) {
    const found = await locator.allTextContents();
    const notices = await locator.page().locator(".notice").allTextContents();
    throw new Error(`expected ${text}, found ${JSON.stringify(found)}; notices: ${JSON.stringify(notices)}`, { cause });
  }
}

/** Waits until what changed before is drawn: what was never on screen is asked about before it is accepted. */
export async function drawn(page) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

/** How many detections the page says are selected. */
export async function selected(page) {
  const text = await page.locator(".work").textContent();
  return Number(text.match(/^([\d,]+) detections? selected/)?.[1].replace(",", "") ?? 0);
}

/** Labels the recording again, with another setting. */
export function relabel(out, setting) {
  ralf("label", RALF_DATASET, "-o", out, "--set", setting, "--quiet");
}

/** Has the page be told that one detection each of the five most doubtful things would be an artifact. */
export async function proposing(page, server) {
  await page.route("**/opinion?*", async (route) => {
    const { doubtful } = await (await ask(server, `sequences/${await sequenceOf(server)}/things/doubtful`)).json();
    const [changes, base] = [[], new Map()];
    for (const thing of doubtful.slice(0, 5)) {
      const { radar, scan, point } = thing;
      const { revision, content } = (await scanOf(server, { radar, scan })).header;
      base.set(`${radar}/${scan}`, { radar, scan, revision, content });
      changes.push({ ...thing, label: 1, probability: 0.9, points: [{ radar, scan, points: [point] }] });
    }
    return route.fulfill({ json: { answered: 40, changes, base: [...base.values()], scans: null } });
  });
}
