// 200,000 LiDAR points and twenty radar scans: drawn only when something changes, and how long a frame takes then.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ask, atEnd, clean, current, drawn, launch, opened, picture, says, scanOf, settled } from "./support.mjs";

const POINTS = 200_000;
/** The view is turned in so many steps of so many pixels. */
const [FRAMES, TURN_PX] = [20, 12];

/** A LiDAR scan made up on rings, as the server would send it. */
const onRings = (i) => {
  const [range, angle] = [3 + (i % 64) * 1.2, (2 * Math.PI * i) / (POINTS / 64)];
  return [range * Math.cos(angle), range * Math.sin(angle), (i % 7) * 0.5];
};

/** Points of a grid of 10 cm around a place. */
const around = (x, y) => (i) => [
  x + 0.1 * ((i % 100) - 50),
  y + 0.1 * ((Math.floor(i / 100) % 100) - 50),
  0.1 * Math.floor(i / 10_000),
];

/** A table as the server sends it, of so many places. */
function lidarTable(count, placeOf, more) {
  const names = ["x", "y", "z", "intensity"];
  const columns = [
    ...names.map((name, i) => ({ name, type: "f32", offset: 4 * count * i })),
    { name: "ground", type: "u8", offset: 16 * count },
  ];
  let header = JSON.stringify({ rows: count, columns, t_ns: "0", odom_from_vehicle: null, ...more });
  while ((4 + header.length) % 8 !== 0) header += " ";
  const body = Buffer.alloc(4 + header.length + 17 * count);
  body.writeUInt32LE(header.length);
  body.write(header, 4);
  const floats = new Float32Array(body.buffer, body.byteOffset + 4 + header.length, 4 * count);
  for (let i = 0; i < count; i += 1) {
    placeOf(i).forEach((value, axis) => floats.set([value], axis * count + i));
  }
  return body;
}

test("200,000 LiDAR points and twenty radar scans are drawn when the view moves, and only then", async (context) => {
  const browser = await launch();
  atEnd(context, () => browser.close());
  const { tab, page } = await opened(context, browser);
  await page.route("**/lidars/*/scans/*", (route) =>
    route.fulfill({ contentType: "application/octet-stream", body: lidarTable(POINTS, onRings) }),
  );
  await page.reload();
  await page.waitForFunction(() =>
    / detections?$/.test(document.querySelector(".scan-title .faint")?.textContent ?? ""),
  );
  for (let more = 0; more < 2; more += 1) await page.keyboard.press(".");
  await page.waitForTimeout(1500);
  await page.keyboard.press("t");
  const [middle, slow] = await turning(page);
  console.log(`Until a frame is painted: median ${middle} ms, 95th percentile ${slow} ms`);
  await page.evaluate(() => {
    const ask = window.requestAnimationFrame.bind(window);
    document.body.dataset.asked = "0";
    window.requestAnimationFrame = (draw) => {
      document.body.dataset.asked = String(Number(document.body.dataset.asked) + 1);
      return ask(draw);
    };
  });
  const asked = () => page.locator("body").getAttribute("data-asked").then(Number);
  await page.waitForTimeout(700);
  assert.equal(await asked(), 0, "frames drawn while nothing changed");
  await page.mouse.wheel(0, 120);
  await page.waitForTimeout(300);
  assert.ok((await asked()) > 0, "no frame drawn after zooming");
  clean(tab);
});

/** How long frames took while the view is turned, ms: the median, and the slowest but one in twenty. */
async function turning(page) {
  const box = await page.locator(".viewport").boundingBox();
  const times = [];
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down({ button: "right" });
  for (let step = 0; step < FRAMES; step += 1) {
    await page.mouse.move(box.x + box.width / 2 + TURN_PX * step, box.y + box.height / 2);
    await drawn(page);
    times.push(Number.parseFloat(await page.locator(".status-bar .frame").textContent()));
  }
  await page.mouse.up({ button: "right" });
  times.sort((a, b) => a - b);
  return [0.5, 0.95].map((share) => times[Math.floor(share * FRAMES)]);
}

test("what is held still has the LiDAR's points of all its scans around it, and lets them go", async (context) => {
  const browser = await launch();
  atEnd(context, () => browser.close());
  const { server, tab, page } = await opened(context, browser, { width: 1280, height: 720 });
  const { sequences } = await (await ask(server, "recording")).json();
  const [{ name, lidars }] = sequences;
  const asked = [];
  await page.route("**/lidars/*/scans/*/near?*", async (route) => {
    const url = new URL(route.request().url());
    const scan = Number(url.pathname.split("/").at(-2));
    asked.push(scan);
    const { odom_from_vehicle } = (await scanOf(server, await current(page))).header;
    const [x, y] = ["x", "y"].map((axis) => Number(url.searchParams.get(axis)));
    // Where the vehicle was when the scan on screen was made: its frame is that of the place then, up to its turn.
    const [east, north] = [x - odom_from_vehicle[3], y - odom_from_vehicle[7]];
    const m = odom_from_vehicle;
    const place = around(m[0] * east + m[4] * north, m[1] * east + m[5] * north);
    const header = { t_ns: lidars[0].scans[scan], odom_from_vehicle };
    return route.fulfill({ contentType: "application/octet-stream", body: lidarTable(100_000, place, header) });
  });
  const points = async () => Number(await page.locator(".viewport").getAttribute("data-lidar-points"));
  const before = await points();
  await page.keyboard.press("z");
  await says(page.locator(".stepper output"), "±100");
  await settled(tab);
  await page.keyboard.press("Control+a");
  await page.keyboard.press("Shift+H");
  await says(page.locator(".notice"), "Held still");
  await settled(tab);
  const read = [...new Set(asked)];
  assert.ok(read.length > 1 && read.length === asked.length, `${name}: ${asked}`);
  const held = await points();
  assert.ok(held > 50_000 && held <= 100_000 * read.length, `${held} points`);
  await page.keyboard.press("t");
  const [middle, slow] = await turning(page);
  console.log(`With ${held} points around what is held: median ${middle} ms, 95th percentile ${slow} ms`);
  await picture(page, "held");
  await page.keyboard.press("Shift+H");
  await settled(tab);
  assert.ok((await points()) > 0 && before > 0);
  clean(tab);
});
