// The page of a study: error against time, with the picture of every setting.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const kMeasures = [
    { name: "RMS error, dB", of: (row) => row.errors.rms_db },
    { name: "RMS error of the worst frame, dB", of: (row) => row.errors.worst_frame_rms_db },
    { name: "Largest error, dB", of: (row) => row.errors.max_db },
    { name: "1 - SSIM", of: (row) => 1 - row.errors.ssim },
    { name: "Interfaces, RMS, mm", of: (row) => row.errors.interface_rms_mm },
    { name: "Interfaces, 95 %, mm", of: (row) => row.errors.interface_p95_mm },
  ];
  const { rows } = data;
  const nameOf = (row) => (row.knob === "preset" ? row.value : `${row.knob} ${row.value}, ${row.sweep}`);
  const ms = (row) => row.timing.ms_per_frame;
  const kilobytes = (row) => number(row.exr_bytes_per_frame / 1000, 4);
  // What storing leaves is smaller than so many decimals tell.
  const small = (value, decimals) => (value > 0 && value < 0.5 * 10 ** -decimals ? number(value, 2) : fixed(value, decimals));
  let picked = rows.find((row) => row.value === "scene") ?? rows[0];

  function showHead() {
    byId("title").textContent = `Accuracy against time: ${data.scene}`;
    const m = data.machine;
    const count = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
    byId("subtitle").textContent = `${count(rows.length, "setting")}, ${count(data.frames.length, "probe frame")}, `
      + `${count(m.rounds, "round")} on ${count(m.threads, "thread")} of ${m.processor}` + (m.complete ? "" : "; stopped before its end");
    byId("foot").textContent = `EchoCine ${data.version}, scene ${data.scene_sha256}. The same numbers are in study.csv and study.json.`;
    byId("difference-scale").textContent = `Difference from the reference: black is none, white ${data.white_difference_db} dB and more`;
  }

  function pick(row) {
    picked = row;
    byId("picked-title").textContent = nameOf(row);
    const images = data.images[row.point];
    byId("thumbnail").src = images.thumbnail;
    byId("difference").src = images.difference;
    const { errors, timing } = row, list = byId("picked");
    list.replaceChildren();
    page.facts(list, [
      ["Time", `${number(timing.ms_per_frame, 3)} ms (${number(timing.first_quartile_ms, 3)} to ${number(timing.third_quartile_ms, 3)})`],
      ["RMS, maximum", `${small(errors.rms_db, 3)}, ${small(errors.max_db, 1)} dB`],
      ["SSIM", fixed(errors.ssim, 4)],
      ["Interfaces", `${fixed(errors.interface_rms_mm, 3)} mm RMS, 95 % within ${fixed(errors.interface_p95_mm, 3)} mm, `
        + `${fixed(100 * errors.interface_missed, 1)} % missed`],
      ["Intensities, stored", row.exr_bytes_per_frame > 0
        ? `${kilobytes(row)} kB, ${number(timing.stages_ms.exr, 3)} ms to encode` : "none"],
      ["Tracer", row.tracer],
      ["Setting", row.setting]]);
  }

  // Smaller is better in both; of nearly equal errors the faster stands.
  function frontOf(points) {
    const sorted = [...points].sort((a, b) => a.value[0] - b.value[0] || a.value[1] - b.value[1]);
    const front = [];
    for (const p of sorted) if (!front.length || p.value[1] < 0.999 * front.at(-1).value[1]) front.push(p);
    return front;
  }

  // No error at all has no place on a log axis: it stands on the floor, a third under the least, and with it
  // what storing alone leaves, which would take up half the axis.
  const kLeastShare = 1 / 1000;
  function floorOf(measure) {
    const errors = rows.map(measure.of);
    const least = kLeastShare * Math.max(...errors), above = errors.filter((e) => e > least);
    return above.length ? Math.min(...above) / 3 : 1e-3;
  }

  function pointsOf(measure, floor, shown) {
    return shown.map((row) => ({ value: [ms(row), Math.max(measure.of(row), floor)], row }));
  }

  // A colour for each knob, whatever is shown; presets stand out, with their names.
  const kColours = [...kCurveColours, "#e8d97a", "#9fdc8c", "#f2a9c4"];
  function lookOf(name) {
    if (name === "presets")
      return { symbol: "diamond", symbolSize: 16, z: 3, itemStyle: { color: page.colour("text"), borderColor: page.colour("card"), borderWidth: 1 },
        label: { show: true, silent: true, position: "top", formatter: (p) => p.data.row.value, fontWeight: "bold", fontSize: 13,
          color: page.colour("text"), textBorderColor: page.colour("card"), textBorderWidth: 4 } };
    const k = data.knobs.findIndex((knob) => knob.name === name);
    return { symbol: k < kCurveColours.length ? "circle" : "triangle", symbolSize: 9,
      itemStyle: { color: kColours[k % kColours.length], opacity: 0.9 } };
  }

  function shownRows() {
    const sweep = byId("sweep").value;
    return rows.filter((row) => sweep === "all" || row.sweep === "preset" || row.sweep === sweep);
  }

  function option() {
    const measure = kMeasures[Number(byId("measure").value)];
    const floor = floorOf(measure), points = pointsOf(measure, floor, shownRows());
    const groups = new Map();
    for (const p of points) {
      const group = p.row.knob === "preset" ? "presets" : p.row.knob;
      groups.set(group, [...(groups.get(group) ?? []), p]);
    }
    const series = [...groups].map(([name, list]) => ({ name, type: "scatter", data: list, ...lookOf(name) }));
    const front = frontOf(points);
    series.unshift({ name: "Pareto front", type: "line", step: "end", data: front.map((p) => p.value), symbol: "none",
      lineStyle: { width: 1.5, type: "dashed", color: page.colour("muted") }, itemStyle: { color: page.colour("muted") },
      silent: true, markLine: { silent: true, z: 1, symbol: "none", precision: 12, data: [{ yAxis: floor }], lineStyle: { color: page.colour("line"), type: "solid" },
        label: { position: "insideStartTop", formatter: `no error, or under ${number(floor, 1)}`, color: page.colour("muted") } } });
    return { legend: { type: "scroll", top: 0, left: 0, right: 0, itemWidth: 16, itemHeight: 11, textStyle: { color: page.colour("text") } }, series,
      yAxis: { name: measure.name } };
  }

  function showFront() {
    const axis = { type: "log", minorTick: { show: true }, axisLabel: { formatter: (v) => number(v, 2), showMinLabel: false, showMaxLabel: false } };
    byId("measure").append(...kMeasures.map((m, i) => element("option", { value: String(i) }, m.name)));
    byId("sweep").append(...[["all", "all"], ["from draft", "up from draft"], ["from reference", "down from reference"]]
      .map(([value, text]) => element("option", { value }, text)));
    const chart = makeChart(byId("front"), 560, {
      grid: { left: 8, right: 70, top: 60, bottom: 34, containLabel: true },
      tooltip: { trigger: "item", confine: true, formatter: (p) => (p.data.row
        ? echarts.format.encodeHTML(`${nameOf(p.data.row)}: ${number(ms(p.data.row), 3)} ms, ${small(p.data.row.errors.rms_db, 2)} dB`) : "") },
      legend: {}, xAxis: { ...axis, min: 0.8 * Math.min(...rows.map(ms)), max: 1.6 * Math.max(...rows.map(ms)), name: "ms per frame", nameLocation: "middle", nameGap: 26 },
      yAxis: { ...axis, nameLocation: "end", nameTextStyle: { align: "left" } }, series: [] });
    const redraw = () => chart.setOption(option(), { replaceMerge: ["series"] });
    for (const id of ["measure", "sweep"]) byId(id).addEventListener("change", redraw);
    let kept = picked;
    chart.on("mouseover", (event) => { if (event.data?.row) pick(event.data.row); });
    chart.on("mouseout", () => pick(kept));
    chart.on("click", (event) => { if (event.data?.row) pick(kept = event.data.row); });
    page.parts.keep = (row) => pick(kept = row);
    redraw();
  }

  function showBuys() {
    const buys = data.machine.best_buys;
    if (!buys.length) {
      byId("buys").textContent = "No knob was swept from draft, or none lowers the error alone.";
      return;
    }
    page.table(byId("buys"), { columns: [{ label: "Knob" }, { label: "from" }, { label: "to" }, { label: "adds, ms", number: true },
      { label: "takes off, dB", number: true }, { label: "dB per ms", number: true }],
    rows: buys.map((b) => [b.knob, b.from, b.to, fixed(b.added_ms, 2), fixed(b.error_drop_db, 2), number(b.db_per_ms, 3)]) });
  }

  function showStages() {
    const presets = rows.filter((row) => row.knob === "preset").reverse();
    const stages = Object.keys(presets[0].timing.stages_ms);
    makeChart(byId("stages"), 250, {
      grid: { left: 8, right: 20, top: 50, bottom: 30, containLabel: true },
      legend: { type: "scroll", top: 0, left: 0, right: 0, itemWidth: 14, itemHeight: 10, itemGap: 8 },
      tooltip: { trigger: "axis", axisPointer: { type: "shadow" }, confine: true, valueFormatter: (v) => `${fixed(100 * v, 1)} %` },
      xAxis: { type: "value", max: 1, name: "share of the frame", nameLocation: "middle", nameGap: 24,
        axisLabel: { formatter: (v) => `${100 * v} %` } },
      yAxis: { type: "category", data: presets.map((row) => `${row.value}, ${number(ms(row), 3)} ms`) },
      series: stages.map((stage) => ({ name: stage.replace("_", " "), type: "bar", stack: "all", data: presets.map((row) => {
        const all = stages.reduce((sum, s) => sum + row.timing.stages_ms[s], 0);
        return all > 0 ? row.timing.stages_ms[stage] / all : 0;
      }) })) });
  }

  function showTable() {
    const button = (row) => element("button", { class: "link", type: "button", click: () => {
      page.parts.keep(row);
      byId("picked-title").scrollIntoView({ behavior: "smooth", block: "center" });
    } }, row.value + (row.timing.pareto ? " *" : ""));
    page.table(byId("table"), { caption: "* on the Pareto front of time and RMS error over all settings",
      columns: [{ label: "Value" }, { label: "Knob" }, { label: "Sweep" }, ...["ms", "quartiles, ms", "RMS, dB", "max, dB", "SSIM",
        "interfaces RMS, mm", "95 %, mm", "missed, %", "EXR, kB"].map((label) => ({ label, number: true }))],
      rows: rows.map((row) => [button(row), row.knob, row.sweep, fixed(ms(row), 2),
        `${fixed(row.timing.first_quartile_ms, 2)}–${fixed(row.timing.third_quartile_ms, 2)}`, small(row.errors.rms_db, 3),
        small(row.errors.max_db, 1), fixed(row.errors.ssim, 4), fixed(row.errors.interface_rms_mm, 3),
        fixed(row.errors.interface_p95_mm, 3), fixed(100 * row.errors.interface_missed, 1), kilobytes(row)]) });
  }

  function showKnobs() {
    page.table(byId("knobs"), { columns: ["Key", "draft", "standard", "fine", "reference", "values"].map((label) => ({ label })),
      rows: data.knobs.map((k) => [k.key, k.presets.draft, k.presets.standard, k.presets.fine, k.presets.reference, k.values.join(", ")]) });
    const refused = data.refused.map((r) => ({ knob: [`${r.knob} ${r.value}`.trim(), r.sweep].filter(Boolean).join(", "), reason: r.reason }));
    const out = [...data.left_out, ...refused];
    if (out.length) byId("left-out").append(element("h2", {}, "Left out"),
      element("ul", {}, ...out.map((l) => element("li", {}, `${l.knob}: ${l.reason}`))));
    page.facts(byId("run"), [["White", `${number(data.reference_intensity)} of the transmitted intensity`],
      ["Dynamic range", `${number(data.dynamic_range_db)} dB`],
      ["Phases of the probe frames", data.frames.map((f) => fixed(f.phase, 3)).join(", ")]]);
  }

  showHead();
  showFront();
  pick(picked);
  showBuys();
  showStages();
  showTable();
  showKnobs();
})();
