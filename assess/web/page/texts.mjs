// Texts and numbers in the language of the page. A text is English in the code, the first argument of `t` or `tn`, and is
// looked up in the catalogue that the server sends.

const MISSING = "–";
const PERCENT = "\u00a0%";
const MOST_DECIMALS = 4;
const YEAR_S = 31536000;
/** Percentages never round across `limits`, those of the classes. */
const catalogue = { language: "en", languages: [["en", "English"]], texts: {}, decimal: ".", group: ",", limits: [] };

/** Read the texts of a language; without one the server chooses by the cookie, the workbook, the browser. */
export async function loadTexts(language = "") {
  const query = language ? `?language=${encodeURIComponent(language)}` : "";
  const answer = await fetch(`/api/texts${query}`, { credentials: "same-origin", cache: "no-store" });
  if (!answer.ok) return catalogue;
  Object.assign(catalogue, await answer.json());
  document.documentElement.lang = catalogue.language;
  if (language) document.cookie = `assess-language=${catalogue.language}; path=/; max-age=${YEAR_S}; SameSite=Strict`;
  return catalogue;
}

/** The language that texts are in, and those that there are as [code, name]. */
export const language = () => catalogue.language;
export const languages = () => catalogue.languages;

/**
 * A text with `values` put into its braces: {name}, {n:,} grouped, {x:.1f} with so many decimals. It is English, a plain string
 * literal, so that it is found for the catalogues.
 */
export function t(text, values) {
  const found = catalogue.texts[text];
  return fill((Array.isArray(found) ? found[0] : found) || text, values);
}

/** The text for one or for many, with {n}. */
export function tn(one, many, n, values) {
  const forms = catalogue.texts[one];
  const found = Array.isArray(forms) ? forms[n === 1 ? 0 : 1] : forms;
  return fill(found || (n === 1 ? one : many), { n, ...values });
}

function fill(text, values) {
  if (!values) return text;
  return text.replace(/\{\{|\}\}|\{(\w+)(?::(,?)(?:\.(\d+)f)?)?\}/g, (all, name, group, digits) => {
    if (all === "{{" || all === "}}") return all[0];
    const value = values[name];
    if (typeof value !== "number") return value ?? "";
    return number(value, digits === undefined ? undefined : Number(digits), Boolean(group));
  });
}

/** A number as the language writes it, with so many decimals, or as many as it has. */
export function number(value, digits, isGrouped = false) {
  if (value === null || value === undefined || !Number.isFinite(value)) return MISSING;
  const plain = digits === undefined ? String(Number(value.toPrecision(12))) : value.toFixed(digits);
  const [whole, decimals] = plain.split(".");
  const grouped = isGrouped ? whole.replace(/\B(?=(\d{3})+$)/g, catalogue.group) : whole;
  return decimals === undefined ? grouped : grouped + catalogue.decimal + decimals;
}

/** A chance in [0, 1] as a percentage that stands on the same side of every class limit; a dash where it is unknown. */
export function percent(chance) {
  if (chance === null || chance === undefined || !Number.isFinite(chance)) return MISSING;
  for (let digits = 1; digits <= MOST_DECIMALS; digits += 1) {
    const shown = Number((100 * chance).toFixed(digits));
    if (!catalogue.limits.some((limit) => chance < limit && limit <= shown / 100)) return `${number(shown, digits)}${PERCENT}`;
  }
  return `${number(100 * chance - 10 ** -MOST_DECIMALS, MOST_DECIMALS)}${PERCENT}`;
}

/** Two chances as a range without signs of percent, rounded outward: "15 to 26". */
export const percents = (low, high) => t("{low} to {high}", { low: number(Math.floor(100 * low + 1e-9)), high: number(Math.ceil(100 * high - 1e-9)) });

/** A size of a file: 12 kB, 3.4 MB. */
export function bytes(count) {
  return count < 1e6 ? `${number(Math.max(1, Math.round(count / 1e3)))} kB` : `${number(count / 1e6, 1)} MB`;
}
