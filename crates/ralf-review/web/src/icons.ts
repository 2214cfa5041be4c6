/** The toolbar's pictures: paths on a grid of 20 by 20, drawn as lines. */

const PATHS = {
  click: "M5 3l10 7-4.4 1L13 16l-2 1-2.4-5L5 15z",
  thing: "M6 6h.2M10 5h.2M14 7h.2M14 11h.2M10 10h.2M6 11h.2M9 14h.2M3 10a7 7 0 1 0 14 0 7 7 0 1 0-14 0z",
  box: "M4 4h12v12H4z",
  lasso:
    "M10 4c4.4 0 7 1.8 7 4.2S14.4 12.5 10 12.5 3 10.6 3 8.2 5.6 4 10 4zM6 12c-1.5 1 -1.5 3 0 3.4 1.4.4 1.8 1.6.8 2.6",
  polygon: "M4 7l6-4 6 5-2 8H6z",
  brush: "M16 3l-7 8M9 11c-2-.6-4 .6-4.2 2.6-.1 1.4-.8 2-1.8 2.4 2.6 1.4 7 .6 7.4-2.6.1-1-.4-2-1.4-2.400z",
  undo: "M7 4L3.5 7.5 7 11M4 7.500h7.500a4.5 4.5 0 0 1 0 9H8",
  redo: "M13 4l3.5 3.500L13 11M16 7.500H8.500a4.5 4.5 0 0 0 0 9H12",
  flip: "M4 7h11l-3-3M16 13H5l3 3",
  invert: "M10 3a7 7 0 1 0 0 14zM10 3a7 7 0 0 1 0 14",
  protect: "M10 3l6 2v5c0 3.5-2.5 6-6 7-3.5-1-6-3.5-6-7V5z",
  check: "M4 10.500l4 4 8-9",
  next: "M5 4l6 6-6 6M14 4v12",
  lidar: "M4 13h.2M7 11h.2M10 9.500h.2M13 11h.2M16 13h.2M6 15h.2M10 13.500h.2M14 15h.2M8 7h.2M12 7h.2",
  ground: "M3 13h14M6 16h8M10 4v6M7.5 7.500L10 10l2.5-2.5",
  overlay: "M3 5h14v10H3zM6 12h.2M8.500 9.500h.2M11 11h.2M13.500 8.500h.2M14 12.500h.2",
  grow: "M12 4h4v4M16 4l-5 5M8 16H4v-4M4 16l5-5",
  home: "M4 8V4h4M12 4h4v4M16 12v4h-4M8 16H4v-4",
} as const;

export type IconName = keyof typeof PATHS;

export function icon(name: IconName): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("class", "icon");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", PATHS[name]);
  svg.append(path);
  return svg;
}
