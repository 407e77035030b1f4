// Sign, word and colour of a risk class, as assess.risk has them: never a colour alone.

import { el } from "./elements.mjs";
import { t } from "./texts.mjs";

/** In falling order. */
export const CLASSES = ["very_high", "high", "medium", "low"];

const SIGNS = { very_high: "■", high: "▲", medium: "◇", low: "○" };
const WORDS = { very_high: () => t("very high"), high: () => t("high"), medium: () => t("medium"), low: () => t("low") };

/**
 * @param {string} key very_high, high, medium, low or "" where a piece has no class
 * @returns {{sign: string, word: string, css: string}} css is the class of page.css that sets its colours: as background and
 *   color of HTML, fill of SVG; in page.css the variables are --very-high and --very-high-ink
 */
export function describe(key) {
  if (!SIGNS[key]) return { sign: "–", word: t("no class"), css: "class-none" };
  return { sign: SIGNS[key], word: WORDS[key](), css: `class-${key.replace("_", "-")}` };
}

/** Sign and word of a class on its colour; `note` is what the title says besides. */
export function badge(key, note = "") {
  const { sign, word, css } = describe(key);
  return el("span", { class: `badge ${css}`, title: note || null }, el("span", { "aria-hidden": "true", text: sign }), ` ${word}`);
}

/** How many pieces each class has, as badges with a number. */
export function countBadges(counts) {
  return [...CLASSES, ""].filter((key) => key || counts[""]).map((key) => {
    const { sign, word, css } = describe(key);
    const n = counts[key] ?? 0;
    const label = t("{word}: {n:,}", { word, n });
    return el("li", { class: `count ${css}`, title: label }, el("span", { "aria-hidden": "true", text: `${sign} ${n}` }), el("span", { class: "unseen", text: label }));
  });
}
