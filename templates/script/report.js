// What is folded opens where a link leads into it, and for printing.
(() => {
  "use strict";
  const open = () => {
    const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let one = target; one; one = one.parentElement) {
      const fold = one.tagName === "DETAILS" ? one : one.querySelector?.(":scope > details");
      if (fold && !fold.open) fold.open = true;
    }
    if (target) target.scrollIntoView();
  };
  addEventListener("hashchange", open);
  addEventListener("DOMContentLoaded", open);
  addEventListener("beforeprint", () => {
    for (const fold of document.querySelectorAll("details")) fold.open = true;
  });
})();

// Filters and sorts the table of all pieces. Without it every row is shown, and the links between plan and table work.
(() => {
  "use strict";
  const FIELDS = ["floor", "room", "class", "route"];
  const table = document.getElementById("pieces");
  const template = document.getElementById("filters");
  if (!table || !template) return;

  const language = document.documentElement.lang || "en";
  const order = new Intl.Collator(language, { numeric: true }).compare;
  // Each part of the table, by what its classes rest on, is a body of its own, and is sorted by itself.
  const heading = (row) => row.classList.contains("part");
  const entries = Array.from(table.tBodies)
    .flatMap((body) => Array.from(body.rows))
    .filter((row) => !heading(row))
    .map((row) => ({ row, body: row.parentElement, search: row.textContent.toLowerCase() }));

  table.parentElement.before(template.content.cloneNode(true));
  const bar = document.getElementById("filter-bar");
  const status = document.getElementById("filter-status");
  const search = document.getElementById("filter-search");
  const selects = FIELDS.map((field) => document.getElementById(`filter-${field}`));
  const [floor, room, , route] = selects;

  const fill = (select, values) => {
    const chosen = select.value;
    while (select.options.length > 1) select.remove(1);
    for (const value of values) select.add(new Option(value, value));
    select.value = values.includes(chosen) ? chosen : "";
  };
  const valuesOf = (field, among) => {
    const found = new Set(among.map(({ row }) => row.dataset[field]));
    found.delete("");
    return [...found];
  };
  const fillRooms = () => {
    const among = floor.value ? entries.filter(({ row }) => row.dataset.floor === floor.value) : entries;
    fill(room, valuesOf("room", among).sort(order));
  };

  const write = (text, values) => text.replace(/\{(\w+)\}/g, (whole, name) => values[name] ?? whole);
  const describe = () => {
    const chosen = selects.filter((select) => select.value);
    const told = chosen.map((select) => `${select.labels[0].textContent}: ${select.selectedOptions[0].text}`);
    if (search.value.trim()) told.push(`“${search.value.trim()}”`);
    return told.join("; ");
  };
  const tell = (shown) => {
    const values = {
      shown: shown.toLocaleString(language),
      total: entries.length.toLocaleString(language),
      filters: describe(),
    };
    const text = values.filters ? status.dataset.filtered : status.dataset.all;
    status.textContent = write(text, values);
    bar.classList.toggle("filtering", values.filters !== "");
  };

  const filter = () => {
    const wanted = FIELDS.map((field, at) => [field, selects[at].value]).filter(([, value]) => value);
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const { row, search: text } of entries) {
      const fits =
        wanted.every(([field, value]) => row.dataset[field] === value) && words.every((word) => text.includes(word));
      if (row.hidden === fits) row.hidden = !fits;
      shown += fits;
    }
    for (const part of table.querySelectorAll("tr.part")) {
      part.hidden = !entries.some(({ row, body }) => body === part.parentElement && !row.hidden);
    }
    tell(shown);
  };
  const clear = () => {
    search.value = "";
    for (const select of selects) select.value = "";
    fillRooms();
    filter();
  };

  const heads = Array.from(table.tHead.rows[0].cells);
  const keyOf = (cell) => cell.dataset.value ?? cell.textContent.trim();
  const compare = (isNumber, sign) => (one, other) => {
    if (one.key === "" || other.key === "") return (one.key === "") - (other.key === "");
    return sign * (isNumber ? one.key - other.key : order(one.key, other.key));
  };
  const sort = (head, direction) => {
    const at = head.cellIndex;
    const isNumber = entries.some(({ row }) => "value" in row.cells[at].dataset);
    const keyed = entries.map(({ row, body }) => ({ row, body, key: keyOf(row.cells[at]) }));
    keyed.sort(compare(isNumber, direction === "ascending" ? 1 : -1));
    for (const other of heads) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", direction);
    for (const { row, body } of keyed) body.append(row);
  };
  const turn = (head) => {
    const now = head.getAttribute("aria-sort");
    const first = entries.length && "value" in entries[0].row.cells[head.cellIndex].dataset ? "descending" : "ascending";
    const second = first === "ascending" ? "descending" : "ascending";
    sort(head, now === first ? second : first);
  };
  for (const head of heads) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "sort";
    button.append(...head.childNodes);
    button.addEventListener("click", () => turn(head));
    head.append(button);
  }

  const unsort = () => {
    for (const head of heads) head.removeAttribute("aria-sort");
    for (const { row, body } of entries) body.append(row);
  };

  // A row that is filtered out is shown before the browser goes to it.
  const reveal = (hash) => {
    const row = hash.startsWith("#row-") ? document.getElementById(hash.slice(1)) : null;
    if (row?.hidden) clear();
    return row;
  };
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#row-"]');
    if (link) reveal(link.getAttribute("href"));
  });
  window.addEventListener("hashchange", () => reveal(location.hash)?.scrollIntoView());

  fill(floor, valuesOf("floor", entries));
  fill(route, valuesOf("route", entries).sort(order));
  fillRooms();
  FIELDS.forEach((field, at) => {
    const values = new Set(entries.map(({ row }) => row.dataset[field]));
    selects[at].parentElement.hidden = values.size < 2;
  });
  floor.addEventListener("change", fillRooms);
  for (const select of selects) select.addEventListener("change", filter);
  search.addEventListener("input", filter);
  document.getElementById("filter-reset").addEventListener("click", () => {
    clear();
    unsort();
  });
  filter();
})();
