// SPDX-License-Identifier: MIT
#pragma once
/// @file The view of fibres in a report: a canvas and its script, without any library. Fibres are drawn from back to front; it
/// turns by the pointer, comes nearer by the wheel or two fingers, and is cut across an axis.

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

  // Of unit length, from point a to point b of a list of points; none where they are one.
  function direction(at, a, b) {
    const u = at[2 * b] - at[2 * a], v = at[2 * b + 1] - at[2 * a + 1], long = Math.hypot(u, v) || 1;
    return [u / long, v / long];
  }
  const closed = data.fibres.map(f => [0, 1, 2].every(n => f.p[n] === f.p[f.p.length - 3 + n]));

  // Half the width and half the height of the fibres in a view, thick as they are.
  function reach(right, up) {
    const across = [right, up].map(v => [0, 1, 2].reduce((sum, n) => sum + Math.abs(v[n]) * (data.high[n] - data.low[n]) / 2, 0));
    return across.map(one => one + thickest);
  }
  const thickest = Math.max(...data.fibres.map(f => f.r));
  let chosen = 0;  // scale of the view that was chosen last

  function draw() {
    asked = false;
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = width * ratio, canvas.height = height * ratio;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(elevation), se = Math.sin(elevation);
    const right = [ca, sa, 0], up = [-sa * se, ca * se, ce], near = [sa * ce, -ca * ce, se];  // to the eye
    const [half_width, half_height] = reach(right, up);
    const fits = Math.min(0.47 * width / half_width, Math.max(height / 2 - 30, 1) / half_height);  // the bar is below
    chosen = chosen || fits;
    const scale = zoom * Math.min(chosen, fits);
    const along = (v, p, k) => v[0] * p[k] + v[1] * p[k + 1] + v[2] * p[k + 2];
    const limit = data.low[axis] + cut * (data.high[axis] - data.low[axis]), pieces = [];
    const x = width / 2 + shift[0], y = (height - 24) / 2 + shift[1];
    // Points in pixels, and at each the vector across the fibre at which two pieces meet.
    const seen = data.fibres.map(function (fibre, number) {
      const p = fibre.p, n = p.length / 3, broken = new Uint8Array(n);
      const at = new Float64Array(2 * n), miter = new Float64Array(2 * n);
      for (let k = 0; k < n; ++k) at[2 * k] = x + scale * along(right, p, 3 * k), at[2 * k + 1] = y - scale * along(up, p, 3 * k);
      for (let k = 0; k < n; ++k) {
        const a = Math.max(k - 1, 0), b = Math.min(k + 1, n - 1), one = direction(at, a, k), two = direction(at, k, b);
        const sum = [one[0] + two[0], one[1] + two[1]], long = sum[0] * sum[0] + sum[1] * sum[1];
        if (k > 0 && k < n - 1 && long < 3) broken[k] = 1;  // turns by more than 60 degrees as it is seen
        else miter[2 * k] = -2 * sum[1] / (long || 1), miter[2 * k + 1] = 2 * sum[0] / (long || 1);
      }
      for (let k = 0; k + 5 < p.length; k += 3)
        if (!(p[k + axis] > limit && p[k + 3 + axis] > limit))
          pieces.push([along(near, p, k) + along(near, p, k + 3), number, k]);
      return {at: at, miter: miter, broken: broken};
    });
    pieces.sort((one, two) => one[0] - two[0]);
    for (const [, number, k] of pieces) {
      const fibre = data.fibres[number], p = fibre.p, {at, miter, broken} = seen[number];
      const wide = 2 * fibre.r * scale, j = 2 * k / 3;
      let a = [at[j], at[j + 1]], b = [at[j + 2], at[j + 3]];
      const own = direction(at, k / 3, k / 3 + 1), square = [-own[1], own[0]];
      let across_a = broken[k / 3] || k === 0 ? square : [miter[j], miter[j + 1]];
      let across_b = broken[k / 3 + 1] || k + 6 >= p.length ? square : [miter[j + 2], miter[j + 3]];
      const from = p[k + axis], to = p[k + 3 + axis];
      let first = k === 0 && !closed[number], last = k + 6 >= p.length && !closed[number];  // where a face shows
      if (from > limit || to > limit) {  // cut within the piece
        const t = (limit - from) / (to - from), c = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        if (from > limit) a = c, across_a = square, first = true; else b = c, across_b = square, last = true;
      }
      const dx = p[k + 3] - p[k], dy = p[k + 4] - p[k + 1], dz = p[k + 5] - p[k + 2], size = Math.hypot(dx, dy, dz) || 1;
      const light = Math.abs(0.3 * dx - 0.5 * dy + 0.8 * dz) / size;  // across the light is bright
      const facing = (near[0] * dx + near[1] * dy + near[2] * dz) / size;
      const band = function (style, w, over) {  // over: pixels beyond each end, so that pieces join
        const u = over * own[0], v = over * own[1], h = 0.5 * w;
        context.fillStyle = style;
        context.beginPath();
        context.moveTo(a[0] - u + h * across_a[0], a[1] - v + h * across_a[1]);
        context.lineTo(b[0] + u + h * across_b[0], b[1] + v + h * across_b[1]);
        context.lineTo(b[0] + u - h * across_b[0], b[1] + v - h * across_b[1]);
        context.lineTo(a[0] - u - h * across_a[0], a[1] - v - h * across_a[1]);
        context.fill();
      };
      const round = function (style, w, place) {  // a joint that turns sharply as it is seen
        context.fillStyle = style, context.beginPath(), context.arc(place[0], place[1], 0.5 * w, 0, 2 * Math.PI), context.fill();
      };
      const rim = wide > 2 ? Math.min(1.6, 0.3 * wide) : 0, tone = tones[number][Math.min(4, Math.floor(5 * (1 - light)))];
      const sharp = [broken[k / 3] && a, broken[k / 3 + 1] && b].filter(place => place);
      band(edges[number], Math.max(wide, 0.8), 0), sharp.forEach(place => round(edges[number], wide, place));
      if (rim > 0) band(tone, wide - rim, 1), sharp.forEach(place => round(tone, wide - rim, place));
      if (wide > 6) band(lights[number], 0.25 * wide, 1);
      for (const [there, sign, at] of [[first, -1, a], [last, 1, b]]) {
        if (!there || sign * facing <= 0 || wide < 2) continue;
        context.beginPath();
        context.ellipse(at[0], at[1], 0.5 * wide * Math.abs(facing), 0.5 * wide, Math.atan2(own[1], own[0]), 0, 2 * Math.PI);
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
      const cx = width - 44, cy = height - 52;
      context.strokeStyle = '#888', context.lineWidth = 1.2;
      context.beginPath(), context.moveTo(cx, cy), context.lineTo(cx + 24 * arrow[1], cy - 24 * arrow[2]), context.stroke();
      if (Math.hypot(arrow[1], arrow[2]) > 0.2) context.fillText(arrow[0], cx + 33 * arrow[1] - 3, cy - 33 * arrow[2] + 4);
    });
  }
  function ask() { if (!asked) asked = true, window.requestAnimationFrame(draw); }

  const held = new Map();  // pointers that are down, and where
  canvas.addEventListener('pointerdown', function (e) {
    held.set(e.pointerId, [e.clientX, e.clientY]), canvas.setPointerCapture(e.pointerId);
  });
  const spread = function () {
    const [one, two] = [...held.values()];
    return Math.hypot(one[0] - two[0], one[1] - two[1]) || 1;
  };
  canvas.addEventListener('pointermove', function (e) {
    if (!held.has(e.pointerId)) return;
    const [x, y] = held.get(e.pointerId), dx = e.clientX - x, dy = e.clientY - y, before = held.size === 2 ? spread() : 1;
    held.set(e.pointerId, [e.clientX, e.clientY]);
    if (held.size === 2) zoom *= spread() / before, shift[0] += 0.5 * dx, shift[1] += 0.5 * dy;
    else if (e.shiftKey || e.buttons > 1) shift[0] += dx, shift[1] += dy;
    else azimuth -= 0.008 * dx, elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, elevation + 0.008 * dy));
    ask();
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, e => held.delete(e.pointerId));
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('wheel', function (e) {
    e.preventDefault(), zoom *= Math.exp(-0.0015 * e.deltaY), ask();
  }, {passive: false});
  document.querySelectorAll('button[data-view]').forEach(function (button) {
    button.addEventListener('click', function () {
      [azimuth, elevation] = views[button.dataset.view], zoom = 1, shift = [0, 0], chosen = 0, ask();
    });
  });
  document.getElementById('axis').addEventListener('change', function (e) { axis = Number(e.target.value), ask(); });
  document.getElementById('cut').addEventListener('input', function (e) { cut = Number(e.target.value) / 1000, ask(); });
  window.addEventListener('resize', function () { chosen = 0, ask(); });
  draw();
})();
)script";

}  // namespace example
