// The page of a scan: the discrepancy and its terms over a heart's dials.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const { axes, points } = data;
  const kTerms = [["discrepancy", "Discrepancy"], ["region", "Region"], ["boundary", "Boundary"], ["motion", "Motion"],
    ["overlap", "Overlap"]];
  const last = axes.at(-1), others = axes.slice(0, -1);

  function showHead() {
    byId("title").textContent = `${axes.map((a) => a.dial).join(", ")} against ${data.real}`;
    const best = points[data.best];
    byId("subtitle").textContent = `lowest discrepancy ${fixed(best.discrepancy, 4)} at `
      + axes.map((a, i) => `${a.dial} ${number(best.values[i])}`).join(", ") + ` · ${points.length} evaluations, ${data.view}${data.caveats.map((text) => ` · ${text}`).join("")}`;
    byId("axis").textContent = others.length
      ? `Along ${last.dial}; a line for each ${others.map((a) => a.dial).join(", ")}.` : `Along ${last.dial}.`;
    byId("foot").textContent = `EchoCine ${data.version}. The same numbers are in scan.csv and scan.json.`;
    byId("notes").hidden = !data.notes.length;
    byId("notes").querySelector("ul").append(...data.notes.map((note) => element("li", {}, note)));
  }

  function showCurves() {
    const per = last.values.length;
    for (const [key, label] of kTerms) {
      const box = element("div", {}, element("h3", {}, label));
      byId("curves").append(box);
      const series = [];
      for (let from = 0; from < points.length; from += per)
        series.push({ type: "line", showSymbol: per < 40, symbolSize: 4,
          name: others.map((a, i) => `${a.dial} ${number(points[from].values[i])}`).join(", ") || label,
          data: points.slice(from, from + per).map((p) => [p.values.at(-1), p[key]]) });
      makeChart(box, 260, { grid: { left: 44, right: 16, top: others.length ? 40 : 16, bottom: 34, containLabel: true },
        legend: others.length ? { top: 0, type: "scroll" } : undefined, tooltip: { trigger: "item", confine: true },
        xAxis: { type: "value", scale: true, name: last.dial, nameLocation: "middle", nameGap: 26 },
        yAxis: { type: "value", scale: true }, series });
    }
  }

  function showLeast() {
    page.table(byId("least"), { columns: [{ label: "dial" }, { label: "best of the scan", number: true },
      { label: "paraboloid's minimum", number: true }, { label: "curvature per step²", number: true }],
    rows: axes.map((a) => [a.dial, number(a.best), a.minimum === null ? "–" : number(a.minimum, 5),
      a.curvature_per_step2 === null ? "–" : number(a.curvature_per_step2, 3)]) });
    const pairs = [];
    data.confounding.forEach((row, i) => row.forEach((value, j) => {
      if (j < i) pairs.push([`${axes[j].dial} with ${axes[i].dial}`, `${fixed(value, 2)} (1 or -1: one compensates the other)`]);
    }));
    page.facts(byId("least"), [...pairs, ["one evaluation", `${number(data.cpu_ms.evaluation, 3)} ms of one core`],
      ["computing hearts", `${number(data.cpu_ms.recording_hearts / 1000, 3)} s of one core`]]);
  }

  // Made when it is opened: thousands of rows cost a second.
  function fillPoints() {
    page.table(byId("points"), { columns: [...axes.map((a) => ({ label: a.dial, number: true })),
      ...[...kTerms.map(([, label]) => label), "lateral, mm", "depth, mm", "turn, °", "scale"].map((label) => ({ label, number: true }))],
    rows: points.map((p) => [...p.values.map((v) => number(v)), ...kTerms.map(([key]) => fixed(p[key], 4)),
      fixed(p.pose.shift_mm[0], 2), fixed(p.pose.shift_mm[1], 2), fixed(p.pose.turn_deg, 2), fixed(p.pose.scale, 4)]) });
  }

  showHead();
  showCurves();
  showFit(data.fit);
  showLeast();
  page.showPose(byId("pose"), "pose at the centre of the ranges", { ...data.centre, tilt: data.tilt, beat: data.beat }, data.beat_anchor);
  byId("points").addEventListener("toggle", fillPoints, { once: true });
})();
