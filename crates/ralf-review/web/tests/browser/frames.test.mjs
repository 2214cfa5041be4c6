// 200,000 LiDAR points and twenty radar scans: drawn only when something changes, and how long a frame takes then.
import assert from "node:assert/strict";
import { test } from "node:test";
import { atEnd, clean, freshOut, launch, open, serve } from "./support.mjs";

const POINTS = 200_000;

/** A LiDAR scan made up on rings, as the server would send it. */
function lidarTable() {
  const names = ["x", "y", "z", "intensity"];
  const columns = [
    ...names.map((name, i) => ({ name, type: "f32", offset: 4 * POINTS * i })),
    { name: "ground", type: "u8", offset: 16 * POINTS },
  ];
  let header = JSON.stringify({ rows: POINTS, columns, t_ns: "0", odom_from_vehicle: null });
  while ((4 + header.length) % 8 !== 0) header += " ";
  const body = Buffer.alloc(4 + header.length + 17 * POINTS);
  body.writeUInt32LE(header.length);
  body.write(header, 4);
  const floats = new Float32Array(body.buffer, body.byteOffset + 4 + header.length, 4 * POINTS);
  for (let i = 0; i < POINTS; i += 1) {
    const [range, angle] = [3 + (i % 64) * 1.2, (2 * Math.PI * i) / (POINTS / 64)];
    floats.set([range * Math.cos(angle)], i);
    floats.set([range * Math.sin(angle)], POINTS + i);
    floats.set([(i % 7) * 0.5], 2 * POINTS + i);
  }
  return body;
}

test("200,000 LiDAR points and twenty radar scans are drawn when the view moves, and only then", async (context) => {
  const browser = await launch();
  atEnd(context, () => browser.close());
  const server = await serve(context, await freshOut(context));
  const tab = await open(context, browser, server);
  const { page } = tab;
  await page.route("**/lidars/*/scans/*", (route) =>
    route.fulfill({ contentType: "application/octet-stream", body: lidarTable() }),
  );
  await page.reload();
  await page.waitForFunction(() =>
    / detections?$/.test(document.querySelector(".scan-title .faint")?.textContent ?? ""),
  );
  for (let more = 0; more < 2; more += 1) await page.keyboard.press(".");
  await page.waitForTimeout(1500);
  await page.keyboard.press("t");
  const box = await page.locator(".viewport").boundingBox();
  const times = [];
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down({ button: "right" });
  for (let step = 0; step < 60; step += 1) {
    await page.mouse.move(box.x + box.width / 2 + 4 * step, box.y + box.height / 2);
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    times.push(Number.parseFloat(await page.locator(".status-bar .frame").textContent()));
  }
  await page.mouse.up({ button: "right" });
  times.sort((a, b) => a - b);
  const [middle, slow] = [times[30], times[57]];
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
