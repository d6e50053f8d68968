// The page of a dataset's preview: some hearts at two instants, and how each dial is distributed.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;

  function duration(seconds) {
    if (seconds < 90) return `${Math.max(1, Math.round(seconds))} s`;
    return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${number(seconds / 3600, 2)} h`;
  }

  function size(bytes) {
    return bytes < 1e9 ? `${number(bytes / 1e6, 2)} MB` : `${number(bytes / 1e9, 2)} GB`;
  }

  byId("title").textContent = `Preview of ${data.name}`;
  byId("subtitle").textContent = `${data.hearts} hearts, ${data.loops} loops as ${data.layouts.join(", ")}; about `
    + `${duration(data.expected_s)} on this machine and ${size(data.expected_bytes)}, extrapolated from the first heart`;
  byId("counted").textContent = `First draws of ${data.counted} hearts, including impossible ones.`;
  byId("foot").textContent = `EchoCine ${data.version}. The contact sheet is next to this page, as PNG.`;

  for (const g of data.previews) {
    const words = `${g.id}: ${g.population}, ejection fraction ${fixed(g.ef_percent, 0)} %, ${fixed(g.edv_ml, 0)} mL`
      + (g.impossible ? `; ${g.impossible} impossible draws before it` : "");
    byId("sheet").append(element("figure", { class: "loop" },
      element("img", { src: g.picture, alt: `${g.view} at end-diastole and end-systole`, style: "width: 100%; height: auto" }),
      element("figcaption", {}, words)));
  }

  // Numbers in bars between the least and the most, words counted; what never varies is left out.
  function barsOf(values) {
    if (typeof values[0] === "string") {
      const names = [...new Set(values)].sort();
      return names.length < 2 ? null : [names, names.map((name) => values.filter((v) => v === name).length)];
    }
    const low = values.reduce((a, b) => Math.min(a, b)), high = values.reduce((a, b) => Math.max(a, b));
    if (low === high) return null;
    const kBars = 20, counts = new Array(kBars).fill(0);
    for (const v of values) counts[Math.min(kBars - 1, Math.floor(kBars * (v - low) / (high - low)))] += 1;
    return [counts.map((_, i) => number(low + (i + 0.5) * (high - low) / kBars, 3)), counts];
  }

  for (const [name, values] of Object.entries(data.drawn)) {
    const bars = barsOf(values);
    if (!bars) continue;
    const box = element("div", {}, element("h3", {}, name));
    byId("drawn").append(box);
    makeChart(box, 150, { grid: { left: 36, right: 8, top: 8, bottom: 22 }, tooltip: { trigger: "axis", confine: true },
      xAxis: { type: "category", data: bars[0] }, yAxis: { type: "value" },
      series: [{ type: "bar", data: bars[1], barCategoryGap: "8%" }] });
  }
})();
