/** Starts the page: reads the recording, builds the views, opens the first scan. */

import { actionsOn } from "./actions/actions.js";
import { closed, firstAddress, nameAmong } from "./actions/starting.js";
import { Api } from "./api/client.js";
import { messageOf } from "./api/errors.js";
import { openSession, randomName } from "./api/session.js";
import type { Recording } from "./api/types.js";
import { CameraView } from "./cameras/camera-view.js";
import { CamerasPanel } from "./cameras/cameras-panel.js";
import { thingCrops } from "./cameras/thing-crops.js";
import { Loader } from "./data/loader.js";
import { deriveAlways } from "./derive.js";
import { h } from "./dom.js";
import { keepNothing, openKeeper } from "./history/keep.js";
import type { Page } from "./page.js";
import { acceptBar } from "./panels/accept-bar.js";
import { banner, notice, painting } from "./panels/banner.js";
import { conflictDialog } from "./panels/conflict-dialog.js";
import { detailsPanel } from "./panels/details-panel.js";
import { classesDialog } from "./panels/classes-dialog.js";
import { helpDialog } from "./panels/help-dialog.js";
import { nameDialog } from "./panels/name-dialog.js";
import { settleBar } from "./panels/settle-bar.js";
import { teamDialog } from "./panels/team-dialog.js";
import { opinionBar } from "./panels/opinion-bar.js";
import { drawn } from "./panels/drawers.js";
import { filterPanel } from "./panels/filter-panel.js";
import { keyTable, listenToKeys } from "./panels/keys.js";
import { legendPanel } from "./panels/legend.js";
import { kindBar } from "./panels/kind-bar.js";
import { QueuePanel } from "./panels/queue-panel.js";
import { replayDialog } from "./panels/replay-dialog.js";
import { ruleBar } from "./panels/rule-bar.js";
import { scanBar, scanTitle } from "./panels/scan-bar.js";
import { statusBar } from "./panels/status-bar.js";
import { thingBar } from "./panels/thing-bar.js";
import { Timeline } from "./panels/timeline.js";
import { toolbar } from "./panels/toolbar.js";
import { keepPreferences } from "./preferences.js";
import { initialState, MOST_ACCUMULATED } from "./state.js";
import { Store } from "./store.js";
import { Viewport } from "./viewer/viewport.js";

async function start(): Promise<void> {
  const session = openSession();
  const recording = await new Api(session, null).recording();
  session.serves(recording.store);
  const api = new Api(session, recording.store);
  const known = session.name();
  if (known !== null) session.rename(nameAmong(recording.people, known));
  const store = new Store(initialState(recording, recording.second ?? session.name() ?? recording.author));
  keepPreferences(store);
  deriveAlways(store);
  const keeper = await openKeeper(recording.store, randomName).catch(keepNothing);
  const actions = actionsOn({ store, api, session, loader: new Loader(api, mostOnScreen(recording)) }, keeper);
  build({ store, actions });
  document.title = `${recording.dataset} · ${recording.out} · RALF review`;
  window.addEventListener("beforeunload", (event) => {
    // What waits for other corrections than are served here is kept until those are back, whatever the page does.
    if (store.state.waiting.length > 0 && store.state.link.kind !== "elsewhere") event.preventDefault();
  });
  // Who works with others is asked once who it is, before anything is opened: each has sequences of its own.
  if (recording.people.length > 0 && recording.second === null && session.name() === null) {
    actions.view.dialog("name");
    await closed(store, "name");
  }
  const first = await firstAddress(recording, store.state.name, location.hash, (name) => api.progress(name));
  if (first === null) return store.set({ loading: false });
  await actions.correct.retry();
  await actions.go.open(first.sequence, first.scan);
}

/** How many scans of a recording may be on screen at once. */
function mostOnScreen({ sequences }: Recording): number {
  return (2 * MOST_ACCUMULATED + 1) * Math.max(...sequences.map(({ radars }) => radars.length), 0);
}

function build(page: Page): void {
  const viewport = new Viewport(page);
  const cameras = new CamerasPanel(page);
  const centreCamera = centreCameraOf(page, viewport, cameras);
  const surfaces = [viewport.surface, centreCamera.surface];
  /** Everything of the scan: what waits to be accepted unseen is shown whatever the filter. */
  const home = (): void => {
    if (page.store.state.accepting !== null) page.actions.view.showEverything();
    viewport.home();
    centreCamera.fit();
  };
  const table = keyTable({
    ...page,
    cancelGesture: () => surfaces.map((surface) => surface.cancel()).some(Boolean),
    closePolygon: () => surfaces.map((surface) => surface.closePolygon("replace")).some(Boolean),
    home,
    seenCamera: () => cameras.seen,
  });
  listenToKeys(table, page.store);
  keepFocus(viewport.element);
  const overlays = [legendPanel(page), scanTitle(page), painting(page)];
  const asked = [
    acceptBar(page, home),
    thingBar(page),
    settleBar(page),
    opinionBar(page),
    ruleBar(page),
    kindBar(page),
  ];
  const told = h("div", { class: "told" }, notice(page), ...asked, banner(page));
  const stage = h(
    "div",
    { class: "stage" },
    viewport.element,
    centreCamera.element,
    ...overlays,
    told,
    conflictDialog(page),
  );
  document.body.append(
    drawn(
      page,
      h(
        "div",
        { class: "layout" },
        h(
          "aside",
          { class: "left", id: "scans", "aria-label": "Scans" },
          new QueuePanel(page).element,
          filterPanel(page),
        ),
        h("main", { class: "centre-column" }, toolbar(page), scanBar(page), stage, new Timeline(page).element),
        h(
          "aside",
          { class: "right", id: "numbers", "aria-label": "Cameras and numbers" },
          cameras.element,
          thingCrops(page),
          detailsPanel(page),
        ),
        statusBar(page),
      ),
    ),
    helpDialog(page, table),
    classesDialog(page),
    nameDialog(page),
    teamDialog(page),
    replayDialog(page),
  );
}

/** The camera's image in the middle, in place of the scene. */
function centreCameraOf(page: Page, viewport: Viewport, cameras: CamerasPanel): CameraView {
  const view = new CameraView(page, true);
  view.element.classList.add("centre");
  page.store.watch(
    ({ mode, cameras: all, chosenCamera }) => [mode, all, chosenCamera],
    (mode, all) => {
      view.element.hidden = mode !== "camera";
      viewport.element.classList.toggle("behind", mode === "camera");
      view.show(mode === "camera" ? (all.find(({ info }) => info.name === cameras.seen) ?? null) : null);
    },
  );
  return view;
}

/** After a press on a button or a choice in a list, keys are for the picture again. */
function keepFocus(picture: HTMLElement): void {
  const back = (target: EventTarget | null): void => {
    const control = target instanceof Element ? target.closest("button, select, input[type=range]") : null;
    if (control !== null && control.closest("dialog, .conflict, .accept") === null)
      picture.focus({ preventScroll: true });
  };
  document.addEventListener("click", (event) => {
    if (event.detail > 0 && !(event.target instanceof HTMLSelectElement)) back(event.target);
  });
  // Arrow keys change a slider again and again.
  document.addEventListener("change", (event) => {
    if (!(event.target instanceof HTMLInputElement)) back(event.target);
  });
}

start().catch((error: unknown) => {
  document.body.append(h("p", { class: "failure", role: "alert" }, `The page could not start: ${messageOf(error)}`));
});
