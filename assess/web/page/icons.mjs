// The icons of the page: one set, drawn with lines on a grid of 24, in the colour of the text around them.

import { svg } from "./elements.mjs";

const PATHS = {
  // the frame
  undo: "M9 7L4 12L9 17M4 12H15A5 5 0 0 1 15 21H12",
  redo: "M15 7L20 12L15 17M20 12H9A5 5 0 0 0 9 21H12",
  menu: "M4 6H20M4 12H20M4 18H20",
  more: "M5 12H5.01M12 12H12.01M19 12H19.01",
  close: "M6 6L18 18M18 6L6 18",
  down: "M6 9L12 15L18 9",
  up: "M6 15L12 9L18 15",
  right: "M9 6L15 12L9 18",
  plus: "M12 5V19M5 12H19",
  minus: "M5 12H19",
  help: "M9 9A3 3 0 1 1 12.8 12C12.2 12.3 12 12.8 12 13.5V14M12 17.5H12.01M21 12A9 9 0 1 1 3 12A9 9 0 1 1 21 12",
  info: "M12 11V16.5M12 7.5H12.01M21 12A9 9 0 1 1 3 12A9 9 0 1 1 21 12",
  warning: "M12 4L21.5 20H2.5ZM12 10V14.5M12 17.2H12.01",
  // files
  download: "M12 4V15M7 10.5L12 15.5L17 10.5M4 20H20",
  folder: "M3 6H9L11 8.5H21V19H3Z",
  external: "M14 4H20V10M20 4L11 13M17 14V20H4V7H10",
  copy: "M9 9H20V20H9ZM15 9V4H4V15H9",
  trash: "M4 7H20M9.5 7V4H14.5V7M6.5 7L7.5 20H16.5L17.5 7M10.5 11V16M13.5 11V16",
  search: "M16.5 10.5A6 6 0 1 1 4.5 10.5A6 6 0 1 1 16.5 10.5M15 15L20 20",
  // the views, by the keys of their tabs
  overview: "M5 21V4H14V21M14 9H19V21M3 21H21M8 8H11M8 12H11M8 16H11",
  sheet: "M4 5H20V19H4ZM4 10H20M4 14.5H20M10 5V19",
  plan: "M4 20V4H20V20H14M10 20H4M4 12H10M14 4V12",
  "what-if": "M4 8H13M17 8H20M4 16H7M11 16H20M15 6V10M9 14V18",
  results: "M4 20H20M7 20V12M12 20V5M17 20V9",
  // the sheet
  "add-row": "M4 4H20V10H4ZM12 14V21M8.5 17.5H15.5",
  // the plan
  fit: "M4 9V4H9M15 4H20V9M20 15V20H15M9 20H4V15M4 4L9.5 9.5M20 4L14.5 9.5M20 20L14.5 14.5M4 20L9.5 14.5",
  select: "M6 4L18.5 13L12.8 14L16 20.5L13.5 21.5L10.4 15L6 19Z",
  measure: "M3 16L16 3L21 8L8 21ZM7 12L9.5 14.5M10.5 8.5L12 10M14 5L16.5 7.5",
  room: "M4 20V4H20V20Z",
  corridor: "M4 8H20M4 16H20M8 12H15M13 9.8L15.2 12L13 14.2",
  door: "M3 20H6V4M6 4A14 14 0 0 1 20 18M6 20H20",
  stair: "M3 20V15H9V11H15V7H21V20Z",
  exit: "M13 4H4V20H13M9 12H20M16 8L20 12L16 16",
  way: "M4 19H11V7H19M15.5 3.5L19 7L15.5 10.5",
  "align-left": "M4 3V21M8 6H20V10H8ZM8 14H15V18H8Z",
  "align-centre": "M12 3V6M12 10V14M12 18V21M5 6H19V10H5ZM8 14H16V18H8Z",
  "align-right": "M20 3V21M4 6H16V10H4ZM9 14H16V18H9Z",
  "align-top": "M3 4H21M6 8V20H10V8ZM14 8V15H18V8Z",
  "align-middle": "M3 12H6M10 12H14M18 12H21M6 5V19H10V5ZM14 8V16H18V8Z",
  "align-bottom": "M3 20H21M6 4V16H10V4ZM14 9V16H18V9Z",
  "distribute-x": "M4 3V21M20 3V21M9.5 8H14.5V16H9.5Z",
  "distribute-y": "M3 4H21M3 20H21M8 9.5H16V14.5H8Z",
  walls: "M3 3H21V21H3ZM6 6H12V9.5H6ZM6 12H9.5V18H6Z",
};

/** An icon as an SVG element, which is also a value of a lit-html template; what it means stands beside it or in a label. */
export function icon(name) {
  return svg("svg", { class: "icon", viewBox: "0 0 24 24", "aria-hidden": "true" }, svg("path", { d: PATHS[name] }));
}
