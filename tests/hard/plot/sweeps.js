// The page of the hard cases: an error over each sweep, on a log axis, with its bound.
"use strict";

(() => {
  const { data, byId, element, number } = page;
  const kFoot = 1e-20, kFloor = 1e-18; // of the axis, and what stands for less: a hundredth of a double's rounding

  // Where a sweep stands on its axis: as it is, by its decades, or by decades on both sides of 0, whichever
  // spreads it. {to, label}: from the variable to the axis, and back as text.
  function axisOf(values) {
    const sizes = values.map(Math.abs).filter((x) => x > 0).sort((a, b) => a - b);
    const least = sizes[Math.floor(sizes.length / 100)], most = sizes.at(-1);
    if (!sizes.length || most / least < 1e3) return { to: (x) => x, label: (u) => number(u, 3),
      step: values.every(Number.isInteger) ? 1 : 0 };
    const power = (u) => number(10 ** u, 1);
    if (values.every((x) => x >= 0))
      return { to: (x) => Math.log10(Math.max(x, least)), label: power, step: 1 };
    const low = Math.floor(Math.log10(least)) - 1; // stands for 0
    return { to: (x) => (Math.abs(x) < least ? 0 : Math.sign(x) * (Math.log10(Math.abs(x)) - low)), step: 1,
      label: (u) => (u === 0 ? "0" : `${u < 0 ? "-" : ""}${power(Math.abs(u) + low)}`) };
  }

  const worstOf = (sweep) => (sweep.worst === null ? "no number" : number(sweep.worst, 2));

  function plot(sweep) {
    const { to, label, step } = axisOf(sweep.points.map(([at]) => at));
    const top = 10 ** (1 + Math.ceil(Math.log10(Math.max(sweep.bound, sweep.worst ?? 1, 1e-15))));
    const points = sweep.points.map(([at, error]) => [to(at), Math.max(error ?? top, kFloor), at, error]);
    const ends = [points[0][0], points.at(-1)[0]];
    const margin = 0.02 * (ends[1] - ends[0]) || 1;
    const root = element("div", {}, element("h3", {}, sweep.case), element("p", { class: "keys" },
      `against ${sweep.against}: worst ${worstOf(sweep)}, bound ${number(sweep.bound, 1)}`));
    byId("plots").append(root);
    const colour = page.colour(sweep.within ? "accent" : "bad");
    makeChart(root, 210, {
      grid: { left: 8, right: 14, top: 12, bottom: 26, containLabel: true },
      tooltip: { trigger: "item", confine: true, formatter: ({ data: p }) =>
        echarts.format.encodeHTML(`${sweep.variable} ${number(p[2], 6)}: ${p[3] === null ? "no number" : number(p[3], 2)}`) },
      xAxis: { type: "value", name: sweep.variable, nameLocation: "middle", nameGap: 26, min: ends[0] - margin, max: ends[1] + margin,
        minInterval: step, splitNumber: 4, axisLabel: { formatter: label, showMinLabel: false, showMaxLabel: false, hideOverlap: true } },
      yAxis: { type: "log", min: kFoot, max: top, interval: 5, axisLabel: { formatter: (v) => number(v, 1), showMinLabel: false, showMaxLabel: false } },
      series: [
        { name: "error", type: "scatter", data: points, symbolSize: sweep.points.length > 200 ? 3 : 6, itemStyle: { color: colour, opacity: 0.8 } },
        ...(sweep.bound > 0 ? [{ name: "bound", type: "line", data: ends.map((x, i) => [x + (i ? margin : -margin), sweep.bound]), symbol: "none",
          silent: true, lineStyle: { type: "dashed", width: 1.5, color: page.colour("warn") } }] : [])] });
  }

  const { sweeps } = data, beyond = sweeps.filter((s) => !s.within).length;
  byId("subtitle").textContent = `${sweeps.length} sweeps, ${sweeps.reduce((sum, s) => sum + s.count, 0)} points, `
    + (beyond ? `${beyond} beyond ${beyond > 1 ? "their bounds" : "its bound"}` : "all within their bounds");
  byId("foot").textContent = `EchoCine ${data.version}. The same points are in the CSV files that the tests wrote.`;
  sweeps.forEach(plot);
  page.table(byId("table"), { columns: [{ label: "Case" }, { label: "against" }, { label: "points", number: true },
    { label: "worst error", number: true }, { label: "at", number: true }, { label: "bound", number: true }, { label: "" }, { label: "File" }],
  rows: sweeps.map((s) => [s.case, s.against, String(s.count), worstOf(s), number(s.worst_at, 4),
    number(s.bound, 1), element("span", { class: s.within ? "on" : "bad" }, s.within ? "within" : "beyond"), s.file]) });
})();
