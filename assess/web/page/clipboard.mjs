// Blocks of cells from and to the clipboard, as Excel, LibreOffice and Google Sheets write and read them. A block is an
// array of rows of values: a text, a number or null.

/** Cells of a text in which tabs part cells and lines part rows; a cell with either, or with quotes, stands in quotes. */
function parseTsv(text) {
  const rows = [];
  let row = [], cell = "", quoted = false, start = true;
  const endCell = () => (row.push(cell), (cell = ""), (start = true));
  const endRow = () => (endCell(), rows.push(row), (row = []));
  for (let i = 0; i < text.length; i++) {
    const sign = text[i];
    if (quoted) {
      if (sign !== '"') cell += sign;
      else if (text[i + 1] === '"') (cell += '"'), i++;
      else quoted = false;
    } else if (sign === '"' && start && isClosed(text, i)) (quoted = true), (start = false);
    else if (sign === "\t") endCell();
    else if (sign === "\n" || sign === "\r") {
      if (sign === "\r" && text[i + 1] === "\n") i++;
      endRow();
    } else (cell += sign), (start = false);
  }
  if (cell !== "" || row.length) endRow();
  return rows;
}

/** Whether a quote that opens a cell has its closing one before a tab, a line break or the end: 12" is no quoted cell. */
function isClosed(text, at) {
  for (let i = at + 1; i < text.length; i++) {
    if (text[i] !== '"') continue;
    if (text[i + 1] === '"') i++;
    else return i + 1 === text.length || /[\t\r\n]/.test(text[i + 1]);
  }
  return false;
}

/** Cells of the first table in an HTML text, null without one. Nothing in it is run or loaded. */
function parseHtml(html) {
  const table = new DOMParser().parseFromString(withoutStyles(html), "text/html").querySelector("table");
  if (!table) return null;
  const block = [];
  const taken = new Set();
  [...table.rows].forEach((line, r) => {
    const row = (block[r] ??= []);
    let c = 0;
    for (const cell of line.cells) {
      while (taken.has(`${r},${c}`)) row[c++] = null;
      row[c] = readCell(cell);
      for (let down = 1; down < Math.min(cell.rowSpan, 1000); down++) {
        for (let right = 0; right < cell.colSpan; right++) taken.add(`${r + down},${c + right}`);
      }
      for (let more = 1; more < cell.colSpan; more++) row[c + more] = null;
      c += cell.colSpan;
    }
  });
  const width = Math.max(0, ...block.map((row) => row.length));
  return block.length && width ? block.map((row) => Array.from({ length: width }, (_, c) => row[c] ?? null)) : null;
}

/** Tags with what is read of them only: the policy of the page refuses styles and handlers, also in a text that is only read. */
function withoutStyles(html) {
  const plain = html.replace(/<(style|script)\b[\s\S]*?<\/\1\s*>/gi, "");
  return plain.replace(/<([a-z][\w:]*)((?:"[^"]*"|'[^']*'|[^'">])*)>/gi, (_, tag, rest) => {
    const kept = [...rest.matchAll(/\s(x:num|sdval|data-sheets-value|colspan|rowspan)\s*=\s*("[^"]*"|'[^']*'|[^\s"'>]+)/gi)];
    return `<${tag}${kept.map((one) => one[0]).join("")}>`;
  });
}

/** The exact number where the program gives it, since what is shown may be rounded; else the text. */
function readCell(cell) {
  const exact = cell.getAttribute("sdval") || cell.getAttribute("x:num") || readSheetsValue(cell);
  if (exact !== null && exact !== "" && Number.isFinite(Number(exact))) return Number(exact);
  const text = readText(cell).split("\n").map((line) => line.trim()).join("\n");
  return text.replaceAll("\u00a0", " ").trim() || null;
}

function readText(node) {
  if (node.nodeType === Node.TEXT_NODE) return node.data.replace(/[ \t\r\n]+/g, " ");
  if (node.nodeName === "BR") return "\n";
  return [...node.childNodes].map(readText).join("");
}

function readSheetsValue(cell) {
  try {
    const value = JSON.parse(cell.getAttribute("data-sheets-value") ?? "null");
    return value?.["1"] === 3 ? value["3"] : null;
  } catch {
    return null;
  }
}

/** The block in what was pasted: exact numbers come from the HTML, line breaks and spaces from the text. */
export function readBlock(data) {
  const plain = parseTsv(data.getData("text/plain"));
  const html = data.getData("text/html");
  const table = html ? parseHtml(html) : null;
  if (!table) return plain;
  if (table.length !== plain.length || table.some((row, r) => row.length !== plain[r].length)) return table;
  return table.map((row, r) => row.map((value, c) => (typeof value === "number" ? value : plain[r][c])));
}

const quote = (text) => (/[\t\n\r"]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** Rows as lines with tabs, which a spreadsheet takes as cells: a text of a stranger's file becomes no formula there. */
export function writeList(rows) {
  const isFormula = (value) => typeof value === "string" && /^\s*[=+\-@\uff1d\uff0b\uff0d\uff20]|^\t/.test(value);
  const write = (value) => (isFormula(value) ? "'" : "") + String(value).replace(/[\t\r\n]+/g, " ");
  return rows.map((row) => row.map(write).join("\t")).join("\n");
}

const ESCAPES = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };
const escapeHtml = (text) => text.replace(/[&<>"]/g, (sign) => ESCAPES[sign]);

/**
 * Put a block on the clipboard as text and as a table, each value as `show(value, column)` has it; texts are marked as such, so
 * that Excel makes no dates of them.
 */
export function writeBlock(data, values, show) {
  const lines = values.map((row) => row.map((value, c) => quote(show(value, c))).join("\t"));
  data.setData("text/plain", lines.join("\r\n"));
  const cells = (row) => row.map((value, c) => writeCell(value, show(value, c))).join("");
  const rows = values.map((row) => `<tr>${cells(row)}</tr>`).join("");
  const head = '<html xmlns:x="urn:schemas-microsoft-com:office:excel"><head><meta charset="utf-8"></head>';
  data.setData("text/html", `${head}<body><table>${rows}</table></body></html>`);
}

function writeCell(value, shown) {
  if (typeof value === "number") return `<td x:num="${value}" sdval="${value}" sdnum="1033;">${escapeHtml(shown)}</td>`;
  const text = escapeHtml(shown).replaceAll("\n", '<br style="mso-data-placement:same-cell">');
  return shown === "" ? "<td></td>" : `<td x:str sdnum="1033;0;@" style="mso-number-format:'\\@'">${text}</td>`;
}
