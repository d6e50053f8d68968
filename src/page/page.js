// What every page starts from: its data, its frames, and elements made of text (never of HTML, so
// that no name in the data can become markup).
"use strict";

const page = {
  data: JSON.parse(document.getElementById("data").textContent),

  // The frames of a loop in their order, each {type, text}: text is base64.
  frames(loop) {
    const found = document.querySelectorAll(`script[data-loop="${CSS.escape(loop)}"]`);
    return Array.from(found, (script) => ({ type: script.type, text: script.textContent }));
  },

  byId(id) { return document.getElementById(id); },

  // element("td", { class: "number" }, "12", child): attributes, and listeners as functions.
  element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (typeof value === "function") made.addEventListener(name, value);
      else if (value !== undefined && value !== false) made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== undefined && child !== null));
    return made;
  },

  // A number to so many significant digits, an en dash for none.
  number(value, digits = 4) {
    if (typeof value !== "number" || !Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e6 || size < 1e-3) return value.toExponential(digits - 1).replace("e+", "e");
    return String(Number(value.toPrecision(digits)));
  },

  // A number with so many decimals.
  fixed(value, decimals) {
    return typeof value === "number" && Number.isFinite(value) ? value.toFixed(decimals) : "–";
  },

  // table(parent, { caption, columns: [{ label, number: true }], rows: [[...]] }): a cell is text, a
  // number, or an element; the first column heads its row.
  table(parent, { caption, columns, rows }) {
    const { element } = page;
    const kind = (column) => ({ class: column.number ? "number" : undefined });
    const cell = (value) => (typeof value === "number" ? page.number(value) : value ?? "–");
    // A name's line may end behind _ and . where a screen is narrow.
    const name = (value) => (typeof value !== "string" ? [cell(value)]
      : value.split(/(?<=[_.])/).flatMap((part, i) => (i ? [element("wbr"), part] : [part])));
    const head = element("thead", {}, element("tr", {},
      ...columns.map((c) => element("th", { scope: "col", ...kind(c) }, c.label))));
    const body = element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map((value, i) =>
      element(i ? "td" : "th", { scope: i ? undefined : "row", ...kind(columns[i]) },
        ...(i ? [cell(value)] : name(value)))))));
    const table = element("table", {}, caption && element("caption", {}, caption), head, body);
    parent.append(element("div", { class: "scroll", tabindex: "0", role: "region",
      "aria-label": caption ?? columns.map((c) => c.label).join(", ") }, table));
    return table;
  },

  // facts(parent, [["name", "value"], ...]): a list of names and what they are.
  facts(parent, pairs) {
    const list = page.element("dl", { class: "facts" });
    for (const [name, value] of pairs)
      list.append(page.element("dt", {}, name), page.element("dd", {}, String(value)));
    parent.append(list);
    return list;
  },

  // A colour of the style sheet as it is now: other ones on paper.
  colour(name) { return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim(); },

  // What a person or a test at the console takes hold of; pages add to it.
  parts: { charts: [] },
};
