// SPDX-License-Identifier: MIT
#pragma once
/// @file The view of fibres in a report: a canvas and its script, without any library. Fibres are drawn from back to front; it
/// turns by the pointer, comes nearer by the wheel, and is cut across an axis.

namespace example {

/// `fibres` is [{c: colour, r: radius, p: [x, y, z, ...]}, ...], all in thousandths of the greatest extent about the middle.
inline constexpr const char* report_viewer = R"script(
(function () {
  'use strict';
  const data = JSON.parse(document.getElementById('fibres').textContent), canvas = document.getElementById('view');
  const context = canvas.getContext('2d'), views = {
    oblique: [-0.65, 0.62], front: [0, 0], side: [-Math.PI / 2, 0], top: [0, Math.PI / 2]
  };
  let [azimuth, elevation] = views.oblique, zoom = 1, shift = [0, 0], axis = 0, cut = 1, asked = false;

  function shade(colour, share) {
    const level = k => Math.round(Math.min(255, parseInt(colour.substr(k, 2), 16) * share));
    return 'rgb(' + level(1) + ',' + level(3) + ',' + level(5) + ')';
  }
  const tones = data.fibres.map(f => [0.86, 0.91, 0.96, 1.01, 1.06].map(share => shade(f.c, share)));
  const edges = data.fibres.map(f => shade(f.c, 0.35)), lights = data.fibres.map(f => shade(f.c, 1.22));

  const closed = data.fibres.map(f => [0, 1, 2].every(n => f.p[n] === f.p[f.p.length - 3 + n]));

  function draw() {
    asked = false;
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = width * ratio, canvas.height = height * ratio;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(elevation), se = Math.sin(elevation);
    const scale = zoom * 1.05 * Math.min(width, 1.5 * height) / (1000 * data.across);
    const right = [ca, sa, 0], up = [-sa * se, ca * se, ce], near = [sa * ce, -ca * ce, se];  // to the eye
    const along = (v, p, k) => v[0] * p[k] + v[1] * p[k + 1] + v[2] * p[k + 2];
    const limit = data.low[axis] + cut * (data.high[axis] - data.low[axis]), pieces = [];
    data.fibres.forEach(function (fibre, number) {
      const p = fibre.p;
      for (let k = 0; k + 5 < p.length; k += 3) {
        if (p[k + axis] > limit && p[k + 3 + axis] > limit) continue;
        pieces.push([along(near, p, k) + along(near, p, k + 3), number, k]);
      }
    });
    pieces.sort((one, two) => one[0] - two[0]);
    const x = width / 2 + shift[0], y = height / 2 + shift[1];
    for (const [, number, k] of pieces) {
      const fibre = data.fibres[number], p = fibre.p, wide = 2 * fibre.r * scale;
      let a = [x + scale * along(right, p, k), y - scale * along(up, p, k)];
      let b = [x + scale * along(right, p, k + 3), y - scale * along(up, p, k + 3)];
      const from = p[k + axis], to = p[k + 3 + axis];
      let first = k === 0 && !closed[number], last = k + 6 >= p.length && !closed[number];  // where a face shows
      if (from > limit || to > limit) {  // cut within the piece
        const t = (limit - from) / (to - from), c = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        if (from > limit) a = c, first = true; else b = c, last = true;
      }
      const dx = p[k + 3] - p[k], dy = p[k + 4] - p[k + 1], dz = p[k + 5] - p[k + 2];
      const light = Math.abs(0.3 * dx - 0.5 * dy + 0.8 * dz) / (Math.hypot(dx, dy, dz) || 1);  // across the light is bright
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      context.lineCap = 'butt';
      const line = function (style, w, over) {  // over: pixels beyond each end, so that pieces join
        const t = over / length;
        context.strokeStyle = style, context.lineWidth = w;
        context.beginPath();
        context.moveTo(a[0] - t * (b[0] - a[0]), a[1] - t * (b[1] - a[1]));
        context.lineTo(b[0] + t * (b[0] - a[0]), b[1] + t * (b[1] - a[1]));
        context.stroke();
      };
      const colour = tones[number][Math.min(4, Math.floor(5 * (1 - light)))];
      line(edges[number], Math.max(wide, 0.8), 0);
      if (wide > 2) line(colour, wide - Math.min(1.6, 0.3 * wide), 1);
      if (wide > 6) line(lights[number], 0.25 * wide, 1);
      const facing = (near[0] * dx + near[1] * dy + near[2] * dz) / (Math.hypot(dx, dy, dz) || 1);
      for (const [there, sign, at] of [[first, -1, a], [last, 1, b]]) {
        if (!there || sign * facing <= 0 || wide < 2) continue;
        context.beginPath();
        context.ellipse(at[0], at[1], 0.5 * wide * Math.abs(facing), 0.5 * wide, Math.atan2(b[1] - a[1], b[0] - a[0]), 0, 2 * Math.PI);
        context.fillStyle = lights[number], context.fill();
        context.strokeStyle = edges[number], context.lineWidth = Math.min(0.8, 0.15 * wide), context.stroke();
      }
    }
    context.fillStyle = '#444', context.font = '13px sans-serif';
    let bar = Math.pow(10, Math.floor(Math.log10(160 * data.size / (1000 * scale))));
    for (const part of [5, 2]) if (part * bar * 1000 * scale / data.size <= 160) { bar *= part; break; }
    const end = 16 + bar * 1000 * scale / data.size;
    context.fillRect(16, height - 18, end - 16, 2);
    context.fillText(bar + ' ' + data.unit, end + 8, height - 12);
    [['x', right[0], up[0]], ['y', right[1], up[1]], ['z', right[2], up[2]]].forEach(function (arrow) {
      const cx = width - 44, cy = height - 44;
      context.strokeStyle = '#888', context.lineWidth = 1.2;
      context.beginPath(), context.moveTo(cx, cy), context.lineTo(cx + 24 * arrow[1], cy - 24 * arrow[2]), context.stroke();
      if (Math.hypot(arrow[1], arrow[2]) > 0.2) context.fillText(arrow[0], cx + 33 * arrow[1] - 3, cy - 33 * arrow[2] + 4);
    });
  }
  function ask() { if (!asked) asked = true, window.requestAnimationFrame(draw); }

  let held = null;
  canvas.addEventListener('pointerdown', function (e) {
    held = [e.clientX, e.clientY, e.shiftKey || e.button > 0], canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener('pointermove', function (e) {
    if (!held) return;
    const dx = e.clientX - held[0], dy = e.clientY - held[1];
    held[0] = e.clientX, held[1] = e.clientY;
    if (held[2]) shift[0] += dx, shift[1] += dy;
    else azimuth -= 0.008 * dx, elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, elevation + 0.008 * dy));
    ask();
  });
  canvas.addEventListener('pointerup', function () { held = null; });
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('wheel', function (e) {
    e.preventDefault(), zoom *= Math.exp(-0.0015 * e.deltaY), ask();
  }, {passive: false});
  document.querySelectorAll('button[data-view]').forEach(function (button) {
    button.addEventListener('click', function () {
      [azimuth, elevation] = views[button.dataset.view], zoom = 1, shift = [0, 0], ask();
    });
  });
  document.getElementById('axis').addEventListener('change', function (e) { axis = Number(e.target.value), ask(); });
  document.getElementById('cut').addEventListener('input', function (e) { cut = Number(e.target.value) / 1000, ask(); });
  window.addEventListener('resize', ask);
  draw();
})();
)script";

}  // namespace example
