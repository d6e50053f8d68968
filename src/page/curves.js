// Curves over the loop, with a cursor that follows the player; a click moves the player there.
"use strict";

// Tones that can be told apart on dark and on white, by most who do not see red or green as well.
const kCurveColours = ["#4aa3df", "#e08a3c", "#58b368", "#d46a9f", "#b89a2f", "#8f83d8", "#3bb3a9", "#d0605a"];

// A chart in root that keeps its size, its colours on paper, and its option's common part. Returns
// the ECharts object.
function makeChart(root, height_px, option) {
  const box = page.element("div", { class: "curve" });
  box.style.height = `${height_px}px`;
  root.append(box);
  const chart = echarts.init(box, null, { renderer: "canvas" });
  chart.setOption({ animation: false, color: kCurveColours, aria: { enabled: true },
    backgroundColor: "transparent", ...option });
  const tint = () => {
    const text = page.colour("text"), muted = page.colour("muted"), line = page.colour("line");
    const axis = { axisLabel: { color: muted }, nameTextStyle: { color: muted },
      axisLine: { lineStyle: { color: line } }, splitLine: { lineStyle: { color: line, opacity: 0.6 } } };
    const axes = (given) => (Array.isArray(given) ? given.map(() => axis) : given ? axis : undefined);
    chart.setOption({ textStyle: { color: text }, xAxis: axes(option.xAxis), yAxis: axes(option.yAxis),
      ...(option.legend ? { legend: { textStyle: { color: text }, inactiveColor: muted, inactiveBorderColor: line,
        pageTextStyle: { color: muted }, pageIconColor: muted, pageIconInactiveColor: line } } : {}),
      tooltip: { backgroundColor: page.colour("ground"), borderColor: line, textStyle: { color: text } } });
  };
  tint();
  new ResizeObserver(() => chart.resize()).observe(box);
  // Print media are told by a query, since beforeprint comes before the style is.
  for (const media of ["print", "(prefers-color-scheme: light)"])
    window.matchMedia(media).addEventListener("change", tint);
  page.parts.charts.push(chart);
  return chart;
}

// The index of the number in ascending xs that is nearest to x.
function nearestIndex(xs, x) {
  let best = 0;
  for (let i = 1; i < xs.length; ++i) if (Math.abs(xs[i] - x) < Math.abs(xs[best] - x)) best = i;
  return best;
}

// Puts a line at frame_x[player.index] across the chart's grid, and moves the player to the frame
// nearest to a click or a drag.
function followPlayer(chart, player, frame_x) {
  const cursor = page.element("div", { class: "cursor" });
  chart.getDom().append(cursor);
  const gridBox = () => chart.getModel().getComponent("grid").coordinateSystem.getRect();
  const place = () => {
    const grid = gridBox();
    cursor.style.top = `${grid.y}px`;
    cursor.style.height = `${grid.height}px`;
    cursor.style.transform = `translateX(${chart.convertToPixel({ xAxisIndex: 0 }, frame_x[Math.max(0, player.index)])}px)`;
  };
  player.addEventListener("frame", place);
  chart.on("finished", place);
  place();
  const go = (event) => {
    const { offsetX: x, offsetY: y } = event, grid = gridBox();
    const kReach_px = 6; // points lie on the grid's edges too
    if (x < grid.x - kReach_px || x > grid.x + grid.width + kReach_px) return;
    if (y < grid.y - kReach_px || y > grid.y + grid.height + kReach_px) return;
    player.jump(nearestIndex(frame_x, chart.convertFromPixel({ xAxisIndex: 0 }, x)));
  };
  const pad = chart.getZr();
  pad.on("click", go);
  pad.on("mousemove", (event) => { if (event.event.buttons === 1) go(event); });
}

// curves(root, { x_name, y_name, frame_x, series: [{ name, values, x, hidden }], player, height_px,
// y_log, y_from_zero, x_range }): one line per series over frame_x, or over its own x. Returns the chart.
function curves(root, { x_name, y_name, frame_x, series, player, height_px = 260, y_log = false,
  y_from_zero = false, x_range, digits = 4 }) {
  const many = series.length > 1;
  const legend = many && { type: "scroll", top: 0, left: 8, right: 8, padding: [5, 10], itemGap: 14, icon: "roundRect",
    itemHeight: 4, itemWidth: 18, textStyle: { padding: [4, 4, 4, 4], lineHeight: 18 },
    selected: Object.fromEntries(series.map((s) => [s.name, !s.hidden])) };
  const chart = makeChart(root, height_px, {
    grid: { left: 8, right: 16, top: many ? 52 : 26, bottom: 26, containLabel: true },
    ...(legend ? { legend } : {}),
    tooltip: { trigger: "axis", axisPointer: { type: "line" }, confine: true,
      valueFormatter: (value) => page.number(value, digits) },
    xAxis: { type: "value", name: x_name, nameLocation: "middle", nameGap: 26, min: x_range?.[0] ?? "dataMin", max: x_range?.[1] ?? "dataMax",
      axisLabel: { formatter: (value) => page.number(value, 3), showMaxLabel: false } },
    yAxis: { type: y_log ? "log" : "value", name: y_name, scale: !y_from_zero, splitNumber: Math.max(2, Math.round(height_px / 60)), nameLocation: "end",
      nameTextStyle: { align: "left" } },
    series: series.map((s) => ({ name: s.name, type: "line", showSymbol: false, lineStyle: { width: 1.8 },
      data: s.values.map((value, i) => [(s.x ?? frame_x)[i], value]) })),
  });
  if (player) followPlayer(chart, player, frame_x);
  return chart;
}
