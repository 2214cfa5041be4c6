/**
 * The colours. Labels have Okabe and Ito's blue and vermilion, as in `ralf plot`, lightened for a dark ground; they
 * can be told apart with any colour vision. Quantities have viridis; the Doppler velocity has a map with two ends.
 */

export type Rgb = readonly [red: number, green: number, blue: number];

export const PLAUSIBLE_RGB: Rgb = [75, 168, 234];
export const ARTIFACT_RGB: Rgb = [240, 128, 60];
export const UNLABELLED_RGB: Rgb = [139, 150, 165];
export const UNCERTAIN_RGB: Rgb = [240, 228, 66];
export const CORRECTED_RGB: Rgb = [255, 255, 255];
export const SELECTED_RGB: Rgb = [94, 234, 166];
export const WAITING_RGB: Rgb = [255, 158, 212];
export const ABSENT_RGB: Rgb = [96, 105, 119];

/** Okabe and Ito's eight without black, for categories. */
export const CATEGORIES: readonly Rgb[] = [
  [86, 180, 233],
  [230, 159, 0],
  [0, 178, 131],
  [204, 121, 167],
  [240, 228, 66],
  [60, 125, 205],
  [235, 108, 52],
  [165, 172, 182],
];

/** Hues by the paper's cluster: construction is yellow, vegetation green, and so on; `moving-` goes with the rest. */
const CLASSES: Readonly<Record<string, Rgb>> = {
  car: [204, 121, 167],
  bicycle: [246, 190, 220],
  bus: [150, 70, 120],
  motorcycle: [232, 84, 160],
  truck: [172, 96, 190],
  "other-vehicle": [122, 96, 128],
  person: [138, 116, 255],
  bicyclist: [190, 176, 255],
  motorcyclist: [104, 78, 206],
  building: [240, 228, 66],
  fence: [172, 158, 30],
  vegetation: [0, 178, 131],
  trunk: [0, 118, 90],
  terrain: [146, 224, 140],
  pole: [230, 159, 0],
  "traffic-sign": [255, 210, 120],
};
/** Of a class of no cluster. */
const OTHER_CLASS: Rgb = [165, 172, 182];

/** The colour of a plausible class. */
export function classColour(name: string): Rgb {
  return CLASSES[name.replace(/^moving-/, "")] ?? OTHER_CLASS;
}

/** Viridis (Smith and van der Walt) at nine even steps; as in `ralf plot`. */
const VIRIDIS: readonly Rgb[] = [
  [68, 1, 84],
  [71, 45, 123],
  [59, 82, 139],
  [44, 114, 142],
  [33, 145, 140],
  [40, 174, 128],
  [94, 201, 98],
  [173, 220, 48],
  [253, 231, 37],
];

/** Blue over a light grey to vermilion: coming, still, going. */
const DIVERGING: readonly Rgb[] = [
  [48, 136, 230],
  [128, 182, 232],
  [214, 216, 218],
  [240, 164, 112],
  [232, 96, 28],
];

/** Viridis' darkest end vanishes on a dark ground, so quantities begin a little above it. */
const VIRIDIS_FROM = 0.16;

export function viridis(share: number): Rgb {
  return interpolate(VIRIDIS, VIRIDIS_FROM + (1 - VIRIDIS_FROM) * share);
}

export function diverging(share: number): Rgb {
  return interpolate(DIVERGING, share);
}

export function cssColour([red, green, blue]: Rgb): string {
  return `rgb(${red} ${green} ${blue})`;
}

function interpolate(stops: readonly Rgb[], share: number): Rgb {
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const first = Math.min(Math.floor(place), stops.length - 2);
  const part = place - first;
  const mix = (channel: 0 | 1 | 2): number =>
    Math.round(stops[first][channel] * (1 - part) + stops[first + 1][channel] * part);
  return [mix(0), mix(1), mix(2)];
}
