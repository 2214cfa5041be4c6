// What an open page makes of labels that were made again, and of a scan that holds other detections by now.
import assert from "node:assert/strict";
import { cp, readFile, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import {
  GONE,
  accept,
  clean,
  current,
  drag,
  drawn,
  freshFolder,
  freshOut,
  launch,
  open,
  pixel,
  ralf,
  relabel,
  says,
  scanOf,
  selected,
  sequenceOf,
  serve,
  settled,
  tableOf,
} from "./support.mjs";

const { RALF_DATASET } = process.env;

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

/** A detection with none of the others near it, well within the picture. */
function lonely({ x, y }) {
  const apart = (i, j) => i === j || Math.hypot(x[i] - x[j], y[i] - y[j]) > 1.5;
  const isLonely = (i) => Math.hypot(x[i], y[i]) < 30 && [...x.keys()].every((j) => apart(i, j));
  return [...x.keys()].findLast(isLonely);
}

test("a stroke is on what it was drawn around, whatever the scan held when the page was opened", async (context) => {
  const folder = await freshFolder(context);
  const [dataset, out] = ["recording", "out"].map((name) => join(folder, name));
  await cp(RALF_DATASET, dataset, { recursive: true });
  const label = () => ralf("label", dataset, "-o", out, "--quiet");
  label();
  const server = await serve(context, out, { dataset });
  const tab = await open(context, browser, server);
  const { page } = tab;
  const id = await current(page);
  const sequence = join(dataset, "sequences", await sequenceOf(server));
  const { rows } = (await scanOf(server, id)).header;
  // The first tenth of the scan's detections is gone.
  const file = join(sequence, id.radar, `${String(id.scan).padStart(6, "0")}.bin`);
  const bytes = await readFile(file);
  const gone = Math.floor(rows / 10);
  await writeFile(file, bytes.subarray((gone * bytes.length) / rows));
  await rm(join(sequence, "ground_truth"), { recursive: true });
  await page.keyboard.press("Control+a");
  await server.kill();
  label();
  const again = await serve(context, out, { dataset, port: server.port });
  await says(page.locator(".notice"), "other detections");
  await says(page.locator(".scan-title"), `${rows - gone} detections`);
  assert.equal(await selected(page), 0, "nothing stays chosen among those that were there");
  const now = await scanOf(again, id);
  const meant = lonely(now);
  const [x, y] = await pixel(page, now.x[meant], now.y[meant]);
  await page.keyboard.press("b");
  await drag(page, [
    [x - 5, y - 5],
    [x + 5, y + 5],
  ]);
  await page.keyboard.press("a");
  await says(page.locator(".status-bar"), "undo 1");
  const { corrected } = await scanOf(again, id);
  assert.deepEqual(
    [...corrected.keys()].filter((point) => corrected[point] === 1),
    [meant],
  );
  clean(tab, GONE);
});

test("after somebody labelled again an answer is about a thing of the new labels", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  await page.keyboard.press("Shift+N");
  await page.locator(".thing-bar:not([hidden])").waitFor();
  await settled(tab);
  relabel(out, "fusion.threshold=0.05");
  await page.keyboard.press("Shift+N");
  await settled(tab);
  const { header, thing: things } = await tableOf(server, "things");
  const names = header.scans.flatMap(({ radar, scan, rows }) =>
    Array.from({ length: rows }, (_, point) => `${radar}/${scan}/${point}`),
  );
  for (let answer = 0; answer < 4; answer += 1) {
    const stroke = page.waitForRequest(/strokes/);
    const shown = await current(page);
    await page.keyboard.press("a");
    const { points } = (await stroke).postDataJSON();
    const chosen = new Set(points.flatMap(({ radar, scan, points: of }) => of.map((one) => `${radar}/${scan}/${one}`)));
    const [meant, ...others] = new Set(things.filter((_, i) => chosen.has(names[i])));
    assert.deepEqual(others, [], "of one thing");
    assert.equal(things.filter((thing) => thing === meant).length, chosen.size, "and of all of it");
    const { radar, scan } = header.doubtful.find(({ thing }) => thing === meant);
    assert.deepEqual({ radar, scan }, shown, "and that is what was shown");
    await settled(tab);
  }
  clean(tab);
});

test("an open page has the threshold of the new labels, and tells accepted ones from the machine's", async (context) => {
  const out = await freshOut(context);
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  const id = await current(page);
  await page.keyboard.press("f");
  await drawn(page);
  await accept(page);
  await says(page.locator(".queue-head"), "1 of");
  await settled(tab);
  relabel(out, "fusion.threshold=1.0");
  await page.keyboard.press("ArrowRight");
  await settled(tab);
  await page.keyboard.press("d");
  await page.waitForFunction(() => document.querySelector(".tick")?.style.left === "100%");
  const { label, machine } = await scanOf(server, id);
  assert.ok(label.some((one, i) => one !== machine[i]));
  await page.goto(`${server.url}#${await sequenceOf(server)}/${id.radar}/${id.scan}`);
  await page.reload();
  await settled(tab);
  // Only what the machine says otherwise is left.
  await page.getByLabel("Labelled by").selectOption("any");
  await page.getByRole("button", { name: "artifact", exact: true }).click();
  await page.keyboard.press("d");
  await says(page.locator(".details h2"), "accepted by ada");
  await says(page.locator(".details .facts").first(), "machineartifact");
  await page.getByLabel("Labelled by").selectOption("machine");
  await says(page.locator(".filters header"), "0 of");
  clean(tab);
});

test("what a model says besides can be read, and its cause isn't taken for the true one", async (context) => {
  const out = await freshOut(context);
  ralf("label", RALF_DATASET, "-o", out, "--method", "learned", "--quiet");
  const server = await serve(context, out);
  const tab = await open(context, browser, server);
  const { page } = tab;
  const { header, machine_cause: causes } = await scanOf(server, await current(page));
  assert.ok(causes.some((cause) => cause > 0));
  await page.getByRole("button", { name: "plausible", exact: true }).click();
  await page.keyboard.press("d");
  await says(page.locator(".details h3"), "Reasons, log odds");
  await says(page.locator(".details .facts").first(), "true cause");
  const named = await page.locator(".details .facts").first().textContent();
  assert.ok(
    header.machine_causes.some((name) => name !== "" && named.includes(`cause by machine${name}`)),
    named,
  );
  const cut = await page
    .locator(".details dt")
    .evaluateAll((names) =>
      names.filter((name) => name.scrollWidth > name.clientWidth).map((name) => name.textContent),
    );
  assert.deepEqual(cut, []);
  clean(tab);
});
