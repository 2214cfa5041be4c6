// What two people said differently: told once both are through, looked at, and settled.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import {
  accept,
  anotherBrowser,
  clean,
  current,
  freshOut,
  launch,
  open,
  picture,
  says,
  selected,
  serve,
  settled,
} from "./support.mjs";
import { faultsOf } from "./faults.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

test("what two people said differently is told once both are through, and settled by a key", async (context) => {
  const tabs = await openedTwice(context);
  const [ada, bob] = tabs.map(({ page }) => page);
  const id = await current(ada);
  await ada.keyboard.press("d");
  const announced = ada.locator(".status-bar .unseen");
  await says(announced, /^Detection 1 of /);
  const wrong = (await announced.innerText()).includes("artifact") ? "p" : "a";
  const right = wrong === "p" ? "artifact" : "plausible";
  await ada.keyboard.press(wrong);
  await says(ada.locator(".status-bar"), "undo 1");
  await says(bob.locator(".status-bar"), "second labels of bob");
  assert.deepEqual(await current(bob), id);
  for (const page of [ada, bob]) {
    await accept(page);
    await says(page.locator(".queue-head"), "1 of");
  }
  await ada.keyboard.press("Shift+T");
  await says(ada.locator("dialog.team"), "κ");
  await faultsOf(ada, "the team");
  await picture(ada, "team");
  await ada.keyboard.press("Escape");
  await ada.keyboard.press("Shift+S");
  await says(ada.locator(".settle-bar"), `bob: ${right}`);
  await says(ada.locator(".past"), "ada");
  await faultsOf(ada, "a disagreement");
  await picture(ada, "disagreement");
  await ada.keyboard.press("6");
  await says(ada.locator(".notice"), "Nothing is left");
  await says(ada.locator(".status-bar"), "undo 3");
  await ada.keyboard.press("Control+z");
  await says(ada.locator(".status-bar"), "redo 1");
  await ada.keyboard.press("Shift+S");
  await says(ada.locator(".settle-bar"), `bob: ${right}`);
  for (const tab of tabs) clean(tab);
});

/** The page of who labels, and that of bob, who labels the same a second time. */
async function openedTwice(context, viewport) {
  const out = await freshOut(context);
  const tabs = [];
  for (const who of [{}, { second: "bob" }]) {
    const server = await serve(context, out, who);
    tabs.push(await open(context, browser, server, await anotherBrowser(context, browser, viewport)));
  }
  return tabs;
}

/** A page on labels of which ada calls all of a scan an artifact and bob says what the machine says. */
async function disagreeing(context, viewport) {
  const tabs = await openedTwice(context, viewport);
  await tabs[0].page.keyboard.press("Control+a");
  await tabs[0].page.keyboard.press("a");
  await says(tabs[0].page.locator(".status-bar"), "undo 1");
  for (const { page } of tabs) {
    await accept(page);
    await says(page.locator(".queue-head"), "1 of");
  }
  await tabs[0].page.keyboard.press("Shift+S");
  await says(tabs[0].page.locator(".settle-bar"), "First: artifact");
  await settled(tabs[0]);
  return tabs[0];
}

for (const [width, height] of [
  [1280, 720],
  [3840, 2160],
]) {
  test(`on ${width} x ${height} a disagreement is in the images, and its bar below what is told`, async (context) => {
    const tab = await disagreeing(context, { width, height });
    const { page } = tab;
    await page.locator(".crop canvas").first().waitFor();
    const scale = await page.evaluate(() =>
      Number(getComputedStyle(document.documentElement).getPropertyValue("--scale")),
    );
    const [bar, stage] = [await page.locator(".settle-bar").boundingBox(), await page.locator(".stage").boundingBox()];
    const below = stage.y + stage.height - bar.y - bar.height;
    assert.ok(Math.abs(below - 12 * scale) < 2, `${below} px below the bar`);
    assert.ok(bar.x >= stage.x && bar.x + bar.width <= stage.x + stage.width);
    await page.keyboard.press("Shift+A");
    await says(page.locator(".settle-bar"), "the filter hides");
    await faultsOf(page, "a disagreement of which the filter hides something");
    await picture(page, `disagreement-hidden-${width}`);
    assert.equal(await selected(page), 0);
    await page.keyboard.press("5");
    await says(page.locator(".notice"), "nothing is settled");
    const told = await page.locator(".notice").boundingBox();
    const now = await page.locator(".settle-bar").boundingBox();
    assert.ok(told.y + told.height <= now.y + 1, "what is told is above the bar");
    await page.keyboard.press("0");
    await page.locator(".settle-bar .spared").waitFor({ state: "hidden" });
    assert.ok((await selected(page)) > 0);
    await picture(page, `disagreement-${width}`);
    clean(tab);
  });
}
