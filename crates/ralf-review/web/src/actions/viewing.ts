/** How things are shown. */

import { type AreaKind, areaOf } from "../data/area.js";
import { everything, type Filter } from "../data/filter.js";
import type { Point } from "../selection/geometry.js";
import { type Dialog, type Drawer, homeOf, type ViewMode } from "../state.js";
import { type ColourMode, colourModes } from "../viewer/colours.js";
import { nameAmong } from "./starting.js";
import { tell, type World } from "./world.js";

const LONGEST_NAME = 64;
const LEAST_DOT = 3;
const MOST_DOT = 24;

export class Viewing {
  constructor(private readonly world: World) {}

  mode(mode: ViewMode): void {
    this.world.store.set({ mode });
  }

  toggleMode(): void {
    const { store } = this.world;
    store.set({ mode: store.state.mode === "bird" ? "free" : "bird" });
  }

  toggleCameraMode(): void {
    const { store } = this.world;
    const { mode, cameras } = store.state;
    if (cameras.length > 0) store.set({ mode: mode === "camera" ? "bird" : "camera" });
  }

  camera(name: string): void {
    this.world.store.set({ chosenCamera: name });
  }

  nextCamera(seen: string | null): void {
    const { store } = this.world;
    const names = store.state.cameras.map(({ info }) => info.name);
    if (names.length > 0) store.set({ chosenCamera: names[(names.indexOf(seen ?? "") + 1) % names.length] });
  }

  colour(colour: ColourMode): void {
    this.world.store.set({ colour });
  }

  nextColour(step: 1 | -1): void {
    const { cloud, recording, colour } = this.world.store.state;
    const names = colourModes(cloud, recording).map(({ value }) => value);
    const now = names.indexOf(colour);
    this.colour(names[(now + step + names.length) % names.length]);
  }

  filter(patch: Partial<Filter>): void {
    const { store } = this.world;
    store.set({ filter: { ...store.state.filter, ...patch } });
  }

  /** Has the next stroke in the scene say where; asked for again, it doesn't. */
  draw(kind: AreaKind): void {
    const { store } = this.world;
    const { drawing, mode } = store.state;
    if (drawing === kind) return store.set({ drawing: null });
    store.set({ drawing: kind, tool: "lasso", mode: mode === "camera" ? "bird" : mode });
    tell(this.world, `Draw ${kind === "inside" ? "an outline" : "along the surface"}; Esc gives it up.`);
  }

  /** A stroke that says where was drawn: x, y in the frame of the scan under review, m. */
  drew(path: readonly Point[]): void {
    const { store } = this.world;
    const { drawing, cloud, filter } = store.state;
    const area = drawing === null ? null : areaOf(drawing, path, cloud, homeOf(store.state));
    store.set({ drawing: null });
    if (area !== null) this.filter({ areas: [...filter.areas, area] });
  }

  showEverything(): void {
    this.world.store.set({ filter: everything });
  }

  toggleRadar(name: string): void {
    const hiddenRadars = new Set(this.world.store.state.filter.hiddenRadars);
    if (!hiddenRadars.delete(name)) hiddenRadars.add(name);
    this.filter({ hiddenRadars });
  }

  toggleLidar(): void {
    const { store } = this.world;
    store.set({ lidarShown: !store.state.lidarShown });
  }

  toggleLidarInImages(): void {
    const { store } = this.world;
    store.set({ lidarInImages: !store.state.lidarInImages });
  }

  toggleLight(): void {
    const { store } = this.world;
    store.set({ light: !store.state.light });
  }

  toggleGround(): void {
    const { store } = this.world;
    store.set({ groundHidden: !store.state.groundHidden });
  }

  dots(step: number): void {
    const { store } = this.world;
    store.set({ dotSize: Math.min(Math.max(store.state.dotSize + step, LEAST_DOT), MOST_DOT) });
  }

  cursor(cursor: readonly [number, number] | null): void {
    this.world.store.set({ cursor });
  }

  drawn(milliseconds: number): void {
    this.world.store.set({ frameTime: milliseconds });
  }

  /** The picture is gone until the graphics card is back, which is told: nothing of it can be looked at. */
  gone(): void {
    tell(this.world, "The graphics card was taken away: the picture comes back with it, or once the page is reloaded.");
  }

  dialog(dialog: Dialog): void {
    this.world.store.set({ dialog });
  }

  /** Opens it, or closes it where it is open. */
  drawer(name: Drawer): void {
    const { store } = this.world;
    store.set({ drawer: store.state.drawer === name ? "none" : name });
  }

  /** What the person is called from now on. */
  rename(typed: string): void {
    const given = typed.trim().slice(0, LONGEST_NAME);
    if (given === "") return;
    const { people } = this.world.store.state.recording;
    const name = nameAmong(people, given);
    if (people.length > 0 && !people.includes(name))
      tell(this.world, `Nothing was dealt to ${name}: team.toml knows ${people.join(", ")}.`);
    this.world.session.rename(name);
    this.world.store.set({ name });
  }

  dismissNotice(): void {
    this.world.store.set({ notice: null });
  }
}
