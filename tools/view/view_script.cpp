#include "tools/view/view_script.h"

namespace ndhull {

const std::string_view kViewStyle = R"css(
body { margin: 0; padding: 14px 24px; background: #fff; color: #333; font: 13px/1.4 "DejaVu Sans", "Helvetica Neue", Arial, sans-serif }
h1 { margin: 6px 0; font-size: 20px; color: #111 }
p { margin: 2px 0; color: #555 }
main { display: flex; flex-wrap: wrap; gap: 8px }
#stage { position: relative; flex: 1 1 480px; min-height: 420px; height: calc(100vh - 120px) }
canvas { width: 100%; height: 100%; display: block; cursor: grab; touch-action: none; outline: none }
canvas:active { cursor: grabbing }
aside { flex: 0 0 236px }
aside form { margin: 8px 0 }
aside label { display: block }
aside button { margin-top: 6px; font: inherit }
#tip { position: absolute; padding: 4px 8px; background: #111d; color: #fff; border-radius: 4px; white-space: pre; pointer-events: none; font-size: 12px }
)css";

const std::string_view kViewScript = R"js(
"use strict";
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const canvas = document.getElementById("drawing");
  const tip = document.getElementById("tip");
  const pen = canvas.getContext("2d");
  const view = {...scene.camera, zoom: 1};
  const corner_radius = Math.hypot(...scene.axes.map(axis => axis.high));
  let to_page, eye, width, height, drawn = [], waiting = false;

  const isOn = id => { const box = document.getElementById(id); return box !== null && box.checked; };
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  function aim() {
    const [ca, sa, ce, se] = [Math.cos(view.azimuth), Math.sin(view.azimuth), Math.cos(view.elevation), Math.sin(view.elevation)];
    const out = [ce * ca, ce * sa, se], right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce];
    eye = out.map(part => part * view.distance);
    // The ball around the box fills the page, whatever way it is turned.
    const reach = corner_radius / Math.sqrt(view.distance ** 2 - corner_radius ** 2);
    const scale = view.zoom * 0.5 * Math.min(width, height) / reach;
    to_page = point => {
      const depth = view.distance - dot(point, out);
      return [width / 2 + scale * dot(point, right) / depth, height / 2 - scale * dot(point, up) / depth];
    };
  }
  const isFacing = (point, normal) => normal[0] * (eye[0] - point[0]) + normal[1] * (eye[1] - point[1]) + normal[2] * (eye[2] - point[2]) > 0;

  function trace(points) {
    pen.beginPath();
    points.forEach(([x, y], index) => index ? pen.lineTo(x, y) : pen.moveTo(x, y));
  }
  function line(from, to) { trace([to_page(from), to_page(to)]); pen.stroke(); }

  function wallFaces(axis, isHigh) {
    const normal = [0, 0, 0], point = [0, 0, 0];
    normal[axis] = isHigh ? 1 : -1;
    point[axis] = isHigh ? scene.axes[axis].high : scene.axes[axis].low;
    return isFacing(point, normal);
  }
  function drawWall(axis) {
    const isHigh = !wallFaces(axis, true);
    if (wallFaces(axis, isHigh)) return;
    const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const [along, across] of [[b, c], [c, b]]) {
      const {low, high, ticks} = scene.axes[across];
      for (const value of [low, high, ...ticks.map(tick => tick.at)]) {
        const from = [0, 0, 0], to = [0, 0, 0];
        from[axis] = to[axis] = isHigh ? scene.axes[axis].high : scene.axes[axis].low;
        from[across] = to[across] = value;
        from[along] = scene.axes[along].low;
        to[along] = scene.axes[along].high;
        line(from, to);
      }
    }
  }
  function drawScale(axis) {
    const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
    let best = null;
    for (const highB of [false, true]) for (const highC of [false, true]) {
      if (wallFaces(b, highB) === wallFaces(c, highC)) continue;
      const place = value => {
        const point = [0, 0, 0];
        point[axis] = value;
        point[b] = highB ? scene.axes[b].high : scene.axes[b].low;
        point[c] = highC ? scene.axes[c].high : scene.axes[c].low;
        return to_page(point);
      };
      const middle = place(0), score = axis === 2 ? -middle[0] : middle[1];
      if (best === null || score > best.score) best = {place, score};
    }
    if (best === null) return;
    const from = best.place(scene.axes[axis].low), to = best.place(scene.axes[axis].high), centre = to_page([0, 0, 0]);
    let out = [to[1] - from[1], from[0] - to[0]];
    const length = Math.hypot(...out);
    if (length < 1) return;
    const sign = out[0] * (from[0] - centre[0]) + out[1] * (from[1] - centre[1]) < 0 ? -1 : 1;
    out = out.map(part => sign * part / length);
    pen.textAlign = out[0] < -0.3 ? "right" : out[0] > 0.3 ? "left" : "center";
    pen.fillStyle = "#666";
    pen.font = "11px sans-serif";
    if (length > 60) for (const tick of scene.axes[axis].ticks) {
      const at = best.place(tick.at);
      pen.fillText(tick.label, at[0] + 9 * out[0], at[1] + 9 * out[1] + (axis === 2 ? 1 : 7));
    }
    pen.fillStyle = "#333";
    pen.font = "600 14px sans-serif";
    const beside = Math.max(42, 18 + 6.6 * Math.max(0, ...scene.axes[axis].ticks.map(tick => tick.label.length)));
    pen.fillText(scene.axes[axis].name, (from[0] + to[0]) / 2 + beside * out[0], (from[1] + to[1]) / 2 + 36 * out[1] + 5);
  }

  function drawGlass(facing) {
    pen.fillStyle = facing ? "rgba(138,143,152,.10)" : "rgba(138,143,152,.05)";
    pen.strokeStyle = facing ? "rgba(93,99,110,.5)" : "rgba(93,99,110,.25)";
    pen.lineWidth = 0.8;
    const pages = scene.glass.corners.map(to_page);
    for (const face of scene.glass.faces) {
      if (isFacing(scene.glass.corners[face.corners[0]], face.normal) !== facing) continue;
      trace(face.corners.map(corner => pages[corner]));
      pen.closePath();
      pen.fill();
      pen.stroke();
    }
  }
  function drawSolid() {
    const pages = scene.solid.corners.map(to_page);
    drawn = [];
    pen.strokeStyle = "rgba(11,47,85,.45)";
    pen.lineWidth = 0.6;
    for (const face of scene.solid.faces) {
      if (!isFacing(scene.solid.corners[face.corners[0]], face.normal)) continue;
      const points = face.corners.map(corner => pages[corner]);
      drawn.push({face, points});
      trace(points);
      pen.closePath();
      pen.fillStyle = face.fill;
      pen.fill();
      pen.stroke();
    }
  }
  function drawMarks() {
    pen.strokeStyle = scene.mark_colour;
    pen.lineWidth = 2;
    const marked = drawn.filter(entry => entry.face.mark > 0);
    for (const {points} of marked) { trace(points); pen.closePath(); pen.stroke(); }
    pen.lineWidth = 1.2;
    for (const [from, to] of scene.outlines) line(from, to);
    pen.font = "700 12px sans-serif";
    pen.textAlign = "center";
    pen.strokeStyle = "#fff";
    pen.lineWidth = 3;
    pen.fillStyle = scene.mark_colour;
    for (const {face, points} of marked) {
      const x = points.reduce((sum, point) => sum + point[0], 0) / points.length;
      const y = points.reduce((sum, point) => sum + point[1], 0) / points.length + 4.5;
      pen.strokeText(face.mark, x, y);
      pen.fillText(face.mark, x, y);
    }
  }

  function draw() {
    waiting = false;
    const ratio = window.devicePixelRatio || 1;
    width = canvas.clientWidth;
    height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineJoin = "round";
    aim();
    if (isOn("show-box")) {
      pen.strokeStyle = "#e3e0da";
      pen.lineWidth = 1;
      for (const axis of [0, 1, 2]) drawWall(axis);
      for (const axis of [0, 1, 2]) drawScale(axis);
    }
    const glass = scene.glass !== null && isOn("show-outer");
    if (glass) drawGlass(false);
    drawSolid();
    if (glass) drawGlass(true);
    if (isOn("show-marks")) drawMarks();
  }
  function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(draw);
  }

  function isInside(points, x, y) {
    let inside = false;
    points.forEach(([ax, ay], index) => {
      const [bx, by] = points[(index + 1) % points.length];
      if ((ay > y) !== (by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay)) inside = !inside;
    });
    return inside;
  }
  function showTip(event) {
    const box = canvas.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
    const hit = drawn.find(entry => isInside(entry.points, x, y));
    tip.hidden = hit === undefined;
    if (hit === undefined) return;
    tip.textContent = hit.face.tip;
    tip.style.left = `${Math.min(x + 14, width - 200)}px`;
    tip.style.top = `${y + 14}px`;
  }
  function turn(right, up) {
    view.azimuth -= right;
    view.elevation = Math.max(-1.55, Math.min(1.55, view.elevation + up));
    redraw();
  }

  canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId); tip.hidden = true; });
  canvas.addEventListener("pointermove", event => {
    if (event.buttons & 1) turn(event.movementX * 0.008, event.movementY * 0.008);
    else showTip(event);
  });
  canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    view.zoom = Math.max(0.3, Math.min(20, view.zoom * Math.exp(-event.deltaY * 0.0015)));
    redraw();
  }, {passive: false});
  const steps = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]};
  canvas.addEventListener("keydown", event => {
    if (!(event.key in steps)) return;
    event.preventDefault();
    turn(...steps[event.key]);
  });
  function reset() { Object.assign(view, scene.camera, {zoom: 1}); redraw(); }
  canvas.addEventListener("dblclick", reset);
  document.getElementById("reset").addEventListener("click", reset);
  for (const box of document.querySelectorAll("input[type=checkbox]")) box.addEventListener("change", redraw);
  new ResizeObserver(redraw).observe(canvas);
  draw();
})();
)js";

}  // namespace ndhull
