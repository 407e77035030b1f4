// Sign, word and colour of a risk class, as assess.risk has them: never a colour alone.

import { el } from "./elements.mjs";
import { percent, percents, t } from "./texts.mjs";

/** In falling order. */
export const CLASSES = ["very_high", "high", "medium", "low"];

const SIGNS = { very_high: "■", high: "▲", medium: "◇", low: "○" };
const WORDS = { very_high: () => t("very high"), high: () => t("high"), medium: () => t("medium"), low: () => t("low") };

/** Sign, word and `css`, the class of page.css that sets its colours, of a class; "" is that of a piece without one. */
export function describe(key) {
  if (!SIGNS[key]) return { sign: "–", word: t("no class"), css: "class-none" };
  return { sign: SIGNS[key], word: WORDS[key](), css: `class-${key.replace("_", "-")}` };
}

/** Sign and word of a class on its colour; `note` is what the title says besides. A pale one is provisional. */
export function badge(key, { note = "", isPale = false } = {}) {
  const { sign, word, css } = describe(key);
  const mark = isPale ? "≈ " : "";
  return el("span", { class: `badge ${css}${isPale ? " pale" : ""}`, title: note || null }, mark, el("span", { "aria-hidden": "true", text: sign }), ` ${word}`);
}

/** Whether a class goes by the formula until its piece has been simulated. `live` is of `store.live`. */
export const isPale = (live) => live?.basis === "formula" && Boolean(live.class);

/** A chance with the range it lies in: "20 % (15 to 26)"; "" by the formula, whose chance suggests more than is known. */
export function chanceText(live) {
  if (!live || live.chance === null || live.chance === undefined || live.basis === "formula" || live.basis === "cannot_rock") return "";
  return live.low === null || live.low === undefined ? percent(live.chance) : t("{chance} ({range})", { chance: percent(live.chance), range: percents(live.low, live.high) });
}

/** What a class rests on, where that is to be said: a word, and what it means. */
export function basisWords(live) {
  const words = [];
  if (isPale(live)) words.push([t("provisional"), t("By the formula, until the piece has been simulated.")]);
  if (live?.basis === "unconfirmed") words.push([t("unconfirmed"), t("Too little is known for the simulated class to count as confirmed: fill in T1, or Height and Storeys, of the building.")]);
  if (live?.basis === "cannot_rock") words.push([t("cannot rock"), t("Too stocky to rock, or the shaking is too weak to start it.")]);
  if (live?.assumed && live.basis !== "formula") words.push([t("assumed motion"), t("No record of this floor is known: its motion is assumed.")]);
  return words;
}

/** The classes of style of a row's class: its colour, and how sure it is. */
export function classStyle(live) {
  if (!live?.class) return "none";
  const marks = [isPale(live) && "pale", live.basis === "unconfirmed" && "unconfirmed", live.basis === "cannot_rock" && "still", live.assumed && !isPale(live) && "assumed"];
  return [describe(live.class).css, ...marks.filter(Boolean)].join(" ");
}

/** A row's class in one text: "≈ ▲ high", then "◇ medium 20 % (15 to 26)", or without the range; a word where it has none. */
export function classText(live, hasRange = true) {
  if (!live) return "";
  if (!live.class) return live.word ?? "";
  const { sign, word } = describe(live.class);
  if (isPale(live)) return `≈ ${sign} ${word}`;
  const state = live.basis === "unconfirmed" ? t("unconfirmed") : live.basis === "cannot_rock" ? t("cannot rock") : "";
  return [sign, word, chanceText(hasRange ? live : { ...live, low: null }), state].filter(Boolean).join(" ");
}

/** The class with all that is known of it, for a panel or a title. */
export function classDetail(live) {
  const parts = basisWords(live).map(([word, why]) => `${word}: ${why}`);
  if (live?.quick && live.class && !isPale(live) && live.quick !== live.class) parts.push(t("By the formula: {word}.", { word: describe(live.quick).word }));
  return parts.join(" ");
}

/** How many pieces each class has, as badges with a number; pale while any of them is provisional. */
export function countBadges(counts, isProvisional = false) {
  return [...CLASSES, ""].filter((key) => key || counts[""]).map((key) => {
    const { sign, word, css } = describe(key);
    const n = counts[key] ?? 0;
    const label = t("{word}: {n:,}", { word, n });
    return el("li", { class: `count ${css}${isProvisional ? " pale" : ""}`, title: label }, el("span", { "aria-hidden": "true", text: `${sign} ${n}` }), el("span", { class: "unseen", text: label }));
  });
}
