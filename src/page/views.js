// The page of a ranking of views: which view of a heart the loop shows, and what heart.
"use strict";

(() => {
  const { data, byId, element, number, fixed } = page;
  const { views, population } = data;
  const best = views[0];
  const heartOf = (v) => population.map((d) => `${d.dial} ${number(v.dials[d.dial], 3)}`).join(", ");

  function showHead() {
    byId("title").textContent = `${best.view}: the view of ${data.real}`;
    byId("subtitle").textContent = `V ${fixed(best.value, 4)}, ${fixed(data.margin, 4)} before ${views[1].view} · confidence `
      + `${fixed(data.confidence, 2)}${population.length ? ` · ${heartOf(best)}` : ""}${data.caveats.map((text) => ` · ${text}`).join("")}`;
    byId("foot").textContent = `EchoCine ${data.version}. The same numbers are in views.csv and views.json.`;
    byId("notes").hidden = !data.notes.length;
    byId("notes").querySelector("ul").append(...data.notes.map((note) => element("li", {}, note)));
  }

  function showRanking() {
    makeChart(byId("bars"), 220, { grid: { left: 44, right: 16, top: 30, bottom: 26, containLabel: true },
      legend: { top: 0 }, tooltip: { trigger: "axis", confine: true, valueFormatter: (value) => fixed(value, 4) },
      xAxis: { type: "category", data: views.map((v) => v.view) }, yAxis: { type: "value", scale: true },
      series: [["V", "value"], ["discrepancy D", "discrepancy"]].map(([name, key]) => (
        { name, type: "bar", data: views.map((v) => v[key]) })) });
    page.table(byId("ranking"), { columns: [{ label: "view" }, ...["V", "coverage a", "D", "region", "boundary", "motion",
      "overlap", ...population.map((d) => d.dial)].map((label) => ({ label, number: true })),
    ...["lateral, mm", "depth, mm", "turn, °", "scale", "pose's confidence"].map((label) => ({ label, number: true }))],
    rows: views.map((v) => [v.view, ...["value", "coverage", "discrepancy", "region", "boundary", "motion", "overlap"]
      .map((key) => fixed(v[key], 4)), ...population.map((d) => number(v.dials[d.dial], 3)),
    fixed(v.pose.shift_mm[0], 1), fixed(v.pose.shift_mm[1], 1), fixed(v.pose.turn_deg, 1), fixed(v.pose.scale, 3),
    fixed(v.pose_confidence, 2)]) });
  }

  // All views in step: boundaries of each view's heart over the loop.
  function showViews() {
    page.parts.player = new Player(byId("views-player"), { rate_hz: 20,
      loops: views.map((v) => {
        const images = page.frames(v.view);
        const draw = (context, _, k) => {
          context.fillStyle = "#ffb347";
          const size = 0.5 / data.fit.mm_per_pixel;
          for (const [x, y] of v.outline[k]) context.fillRect(x - size, y - size, 2 * size, 2 * size);
        };
        return { label: `${v.view}: V ${fixed(v.value, 3)}, D ${fixed(v.discrepancy, 3)}${heartOf(v) ? `, ${heartOf(v)}` : ""}`, images, over: { images, draw } };
      }),
      describe: (k) => `picture ${k} of ${best.outline.length} of the beat, from end-diastole` });
  }

  function showHeart() {
    page.facts(byId("heart"), [...Object.entries(best.dials).map(([key, value]) => [key, number(value, 4)]),
      ["hearts that were tried", String(best.hearts)],
      ["the middle heart's discrepancy", fixed(best.discrepancy_of_middle_heart, 4)],
      ["computing hearts", `${number(data.cpu_ms.recording_hearts / 1000, 3)} s of one core`],
      ["all of it", `${number(data.cpu_ms.all / 1000, 3)} s of one core`]]);
  }

  showHead();
  showRanking();
  showViews();
  showFit(data.fit);
  showHeart();
  page.showPose(byId("pose"), "pose", { ...best, confidence: best.pose_confidence }, data.beat_anchor);
})();
