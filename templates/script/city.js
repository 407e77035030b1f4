// The map, the ranking and the page of each building of a city, from the data in the page. Texts are set as text alone.
(() => {
  "use strict";
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);
  const texts = byId("texts").dataset;
  const { buildings, tables, styles } = data;
  const language = document.documentElement.lang || "en";
  const whole = (value) => value.toLocaleString(language);
  const write = (text, values) => text.replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);
  const make = (name, text = "", style = "") => {
    const element = document.createElement(name);
    if (text) element.textContent = text;
    if (style) element.className = style;
    return element;
  };

  // ---------------------------------------------------------------- the map
  const svg = document.querySelector("svg.city-map");
  const legend = (mode) =>
    new Map(Array.from(byId(`legend-${mode}`)?.querySelectorAll("svg") ?? [], (sign) => [sign.dataset.key, sign]));
  const MODES = ["share", "kind", "state"];
  const signs = svg ? Object.fromEntries(MODES.map((mode) => [mode, legend(mode)])) : {};
  const names = {
    kind: new Map(Array.from(byId("filter-kind").options, (one) => [one.value, one.text])),
    state: new Map(Array.from(byId("filter-state").options, (one) => [one.value, one.text])),
  };
  const marks = svg ? Array.from(svg.querySelectorAll(".marks > g")) : [];
  const markOf = new Map(marks.map((mark) => [Number(mark.dataset.at), mark]));
  const full = svg ? { x: 0, y: 0, wide: svg.viewBox.baseVal.width, high: svg.viewBox.baseVal.height } : null;
  let view = full && { ...full };

  // On a small screen signs and letters are drawn larger, in half steps, so that the scale bar keeps a round length.
  const enlarge = () => Math.max(1, Math.round((1.6 * full.wide) / Math.max(svg.clientWidth, 1)) / 2);
  const placeFixed = (scale) => {
    const kilometres = svg.querySelector(".scale-bar");
    const north = svg.querySelector(".north");
    kilometres.setAttribute("transform", `translate(${view.x} ${view.y + view.high}) scale(${scale}) translate(0 ${-full.high})`);
    north.setAttribute("transform", `translate(${view.x + view.wide} ${view.y}) scale(${scale}) translate(${-full.wide} 0)`);
    const length = Number(kilometres.dataset.km) * scale;
    const text = length >= 1 ? texts.kilometres : texts.metres;
    const value = length >= 1 ? length : 1000 * length;
    kilometres.querySelector("text").textContent = write(text, { length: Number(value.toPrecision(3)).toLocaleString(language) });
  };
  const show = () => {
    const scale = (view.wide / full.wide) * enlarge();
    svg.setAttribute("viewBox", `${view.x} ${view.y} ${view.wide} ${view.high}`);
    svg.classList.toggle("near", view.wide < full.wide);
    for (const mark of marks) {
      const { x, y, size } = mark.dataset;
      mark.setAttribute("transform", `translate(${x} ${y}) scale(${Number(size) * scale})`);
    }
    for (const degree of svg.querySelectorAll("text.degree, text.isoline, text.halo")) degree.setAttribute("font-size", 11 * scale);
    placeFixed(scale);
  };
  const keep = (value, low, high) => Math.min(Math.max(value, low), high);
  const zoom = (factor, across = 0.5, down = 0.5) => {
    const wide = keep(view.wide / factor, full.wide / 256, full.wide);
    const high = (wide / full.wide) * full.high;
    view = {
      x: keep(view.x + (view.wide - wide) * across, 0, full.wide - wide),
      y: keep(view.y + (view.high - high) * down, 0, full.high - high),
      wide,
      high,
    };
    show();
  };
  const move = (across, down) => {
    view.x = keep(view.x + across * view.wide, 0, full.wide - view.wide);
    view.y = keep(view.y + down * view.high, 0, full.high - view.high);
    show();
  };
  const setSigns = (mode) => {
    for (const [at, mark] of markOf) {
      const sign = signs[mode].get(buildings[at][mode]);
      const title = mark.querySelector("title");
      if (sign) mark.replaceChildren(...Array.from(sign.children, (part) => part.cloneNode(true)));
      if (title) mark.append(title);
    }
    // the legend begins with the worst, which is to lie on top
    for (const key of [...signs[mode].keys()].reverse()) {
      svg.querySelector(".marks").append(...marks.filter((mark) => buildings[Number(mark.dataset.at)][mode] === key));
    }
    for (const other of MODES) byId(`legend-${other}`).classList.toggle("chosen", other === mode);
  };

  const startMap = () => {
    svg.setAttribute("tabindex", "0");
    byId("zoom-in").addEventListener("click", () => zoom(2));
    byId("zoom-out").addEventListener("click", () => zoom(0.5));
    byId("zoom-all").addEventListener("click", () => {
      view = { ...full };
      show();
    });
    byId("map-signs").addEventListener("change", (event) => setSigns(event.target.value));
    svg.addEventListener("wheel", (event) => {
      if (document.activeElement !== svg && !event.ctrlKey) return;
      event.preventDefault();
      const box = svg.getBoundingClientRect();
      zoom(event.deltaY < 0 ? 1.25 : 0.8, (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    }, { passive: false });
    svg.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: [-0.2, 0], ArrowRight: [0.2, 0], ArrowUp: [0, -0.2], ArrowDown: [0, 0.2] };
      if (event.key === "+" || event.key === "=") zoom(2);
      else if (event.key === "-") zoom(0.5);
      else if (steps[event.key]) move(...steps[event.key]);
      else return;
      event.preventDefault();
    });
    let from = null;
    svg.addEventListener("pointerdown", (event) => {
      from = { x: event.clientX, y: event.clientY, moved: false };
    });
    svg.addEventListener("pointermove", (event) => {
      if (!from || event.buttons === 0) return;
      const box = svg.getBoundingClientRect();
      const across = event.clientX - from.x;
      const down = event.clientY - from.y;
      if (!from.moved && Math.hypot(across, down) < 4) return;
      if (!from.moved) svg.setPointerCapture(event.pointerId);
      svg.classList.add("moving");
      move(-across / box.width, -down / box.height);
      from = { x: event.clientX, y: event.clientY, moved: true };
    });
    svg.addEventListener("pointerup", () => svg.classList.remove("moving"));
    svg.addEventListener("pointercancel", () => svg.classList.remove("moving"));
    svg.addEventListener("click", (event) => {
      const mark = event.target.closest(".marks > g");
      const wasMoved = from?.moved;
      from = null;
      if (mark && !wasMoved) location.hash = `building-${Number(mark.dataset.at) + 1}`;
    });
    svg.addEventListener("pointerover", (event) => {
      const mark = event.target.closest(".marks > g");
      if (!mark || mark.querySelector("title")) return;
      const title = document.createElementNS("http://www.w3.org/2000/svg", "title");
      title.textContent = buildings[Number(mark.dataset.at)].name;
      mark.append(title);
    });
  };
  if (svg) {
    startMap();
    show();
    window.addEventListener("resize", show);
  }

  // ---------------------------------------------------------------- the ranking
  const STEP = window.matchMedia("(max-width: 48rem)").matches ? 20 : 100;
  const FIELDS = ["use", "kind", "state", "inventory", "storeys"];
  const heads = Array.from(byId("ranked").tHead.rows[0].cells, (head) => head.textContent);
  const body = byId("ranked").tBodies[0];
  const selects = FIELDS.map((field) => byId(`filter-${field}`));
  const search = byId("filter-text");
  const more = byId("more");
  const searched = buildings.map((one) => [one.name, one.path, one.use].join(" ").toLowerCase());
  let found = buildings.map((_one, at) => at);
  let shown = 0;

  const matches = (one, field, value) => {
    if (field !== "storeys") return one[field] === value;
    const [low, high] = value.split("-").map(Number);
    return one.storeys !== null && one.storeys >= low && one.storeys <= high;
  };
  const makeRow = (at) => {
    const one = buildings[at];
    const row = make("tr");
    const head = make("th");
    head.scope = "row";
    const open = make("button", one.name);
    open.type = "button";
    open.addEventListener("click", () => {
      location.hash = `building-${at + 1}`;
    });
    head.append(open);
    row.append(head);
    one.cells.forEach((text, place) => {
      const cell = make("td", place === 2 ? "" : text, place > 2 ? "num" : "");
      cell.dataset.label = heads[place + 1];
      if (place === 2) cell.append(make("span", `${signText(one.kind)}${names.kind.get(one.kind) ?? ""}`, `badge ${one.kind}`));
      row.append(cell);
    });
    return row;
  };
  const SIGNS = { low: "○ ", medium: "◇ ", high: "▲ ", "very-high": "■ ", anchored: "⚓ ", unconfirmed: "◌ ", "by-formula": "ƒ ", skipped: "× " };
  const signText = (key) => SIGNS[key] ?? "";
  const addRows = () => {
    const next = found.slice(shown, shown + STEP);
    body.append(...next.map(makeRow));
    shown += next.length;
    const left = found.length - shown;
    more.hidden = left === 0;
    more.textContent = write(texts.more, { count: whole(Math.min(left, STEP)) });
  };
  const filter = () => {
    const wanted = FIELDS.map((field, at) => [field, selects[at].value]).filter(([, value]) => value);
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    found = [];
    buildings.forEach((one, at) => {
      const fits = wanted.every(([field, value]) => matches(one, field, value)) && words.every((word) => searched[at].includes(word));
      if (fits) found.push(at);
      markOf.get(at)?.toggleAttribute("hidden", !fits);
    });
    body.replaceChildren();
    shown = 0;
    addRows();
    const told = selects.filter((one) => one.value).map((one) => `${one.labels[0].textContent}: ${one.selectedOptions[0].text}`);
    if (search.value.trim()) told.push(`“${search.value.trim()}”`);
    byId("filter-bar").classList.toggle("filtering", told.length > 0);
    byId("filter-status").textContent = write(told.length ? texts.some : texts.all, {
      shown: whole(found.length), total: whole(buildings.length), filters: told.join("; "),
    });
  };
  byId("filter-bar").hidden = false;
  for (const select of selects) select.addEventListener("change", filter);
  search.addEventListener("input", filter);
  more.addEventListener("click", addRows);
  byId("filter-reset").addEventListener("click", () => {
    for (const select of selects) select.value = "";
    search.value = "";
    filter();
  });
  filter();

  // ---------------------------------------------------------------- one building
  const all = byId("all");
  const page = byId("one");
  const cover = document.querySelector("header.cover");
  const allTitle = document.title;

  const readRows = (name, at) => {
    const table = tables[name];
    const rows = [];
    for (let row = table.starts[at]; row < table.starts[at + 1]; row += 1) {
      rows.push(table.columns.map((column, place) => table.texts[place][column[row]]));
    }
    return rows;
  };
  const makeTable = (name, rows, left) => {
    const { heads: labels, numeric } = tables[name];
    const used = labels.map((_label, place) => place === 0 || rows.some((row) => row[place] !== ""));
    const table = make("table");
    const line = table.createTHead().insertRow();
    labels.forEach((label, place) => {
      if (!used[place]) return;
      const head = make("th", label, numeric.includes(place) ? "num" : "");
      head.scope = "col";
      line.append(head);
    });
    const rowsOf = table.createTBody();
    for (const row of rows) {
      const line = rowsOf.insertRow();
      row.forEach((text, place) => {
        if (!used[place]) return;
        const cell = make("td", "", numeric.includes(place) ? "num" : "");
        cell.dataset.label = labels[place];
        const style = styles[text[0]];
        if (style && text[1] === " ") cell.append(make("span", text, style.startsWith("way") ? style : `badge ${style}`));
        else cell.textContent = text;
        line.append(cell);
      });
    }
    return left ? [table, make("p", write(texts.left, { count: whole(left) }), "small")] : [table];
  };
  const addPart = (title, parts) => {
    const section = make("section");
    section.append(make("h2", title), ...parts);
    page.append(section);
  };
  const fillFacts = (one) => {
    const table = make("table", "", "facts");
    const rows = table.createTBody();
    one.facts.forEach((text, place) => {
      if (!text) return;
      const line = rows.insertRow();
      const head = make("th", data.heads[place]);
      head.scope = "row";
      line.append(head, make("td", text));
    });
    return table;
  };
  const openBuilding = (at) => {
    const one = buildings[at];
    const section = make("section");
    const back = make("button", page.dataset.back, "back");
    back.type = "button";
    back.addEventListener("click", () => {
      location.hash = "";
    });
    const title = make("h1", one.name);
    title.tabIndex = -1;
    const place = write(texts.title, { place: whole(at + 1), total: whole(buildings.length) });
    section.append(back, make("p", place, "kind"), title);
    if (!one.facts.length) section.append(make("p", texts.skipped, "caution"), make("p", one.path));
    if (one.inventory === "assumed") section.append(make("p", texts.assumed, "caution"));
    if (one.facts.length) section.append(fillFacts(one));
    page.replaceChildren(section);
    const pieces = readRows("pieces", at);
    const fixes = pieces.filter((row) => row[8] !== "").slice(0, 10);
    if (fixes.length) addPart(texts.fixes, makeTable("pieces", fixes, 0));
    for (const name of ["routes", "problems"]) {
      const rows = readRows(name, at);
      if (rows.length) addPart(texts[name], makeTable(name, rows, tables[name].left[at]));
    }
    if (pieces.length) addPart(texts.pieces, makeTable("pieces", pieces, tables.pieces.left[at]));
    const typed = one.indexed ? [make("p", texts.index, "small")] : [];
    if (one.command) addPart(texts.alone, [make("pre", one.command), ...typed]);
    for (const scrolled of page.querySelectorAll("pre")) scrolled.tabIndex = 0;
    document.title = one.name;
    return title;
  };
  let last = null;
  const follow = () => {
    const at = Number(/^#building-(\d+)$/.exec(location.hash)?.[1] ?? 0) - 1;
    const isOne = at >= 0 && at < buildings.length;
    all.hidden = isOne;
    cover.hidden = isOne;
    page.hidden = !isOne;
    if (isOne) {
      const title = openBuilding(at);
      window.scrollTo(0, 0);
      title.focus({ preventScroll: true });
      last = at;
    } else {
      page.replaceChildren();
      document.title = allTitle;
      if (last !== null) {
        const button = body.rows[found.indexOf(last)]?.querySelector("button");
        (button ?? svg)?.focus();
        last = null;
      }
    }
  };
  window.addEventListener("hashchange", follow);
  follow();
})();
