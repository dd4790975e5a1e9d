'use strict';
/* The viewer of mskit's pages. It draws clumps and shapes that stand in the page as JSON (ms_view_scene.h says how) with
   WebGL 2: each sphere is a square in which the ray through a pixel is cut with the sphere, so that it is round at any
   size and costs its pixels alone; a shape is triangles. The projection is parallel. Nothing is drawn but on change. The
   programs of both are in shaders.js, which goes before. */
(function () {
const byId = id => document.getElementById(id);
const scenes = JSON.parse(byId('scenes').textContent);
const canvas = byId('canvas');
const gl = canvas.getContext('webgl2', {antialias: false, alpha: false});

/* Viridis for what has a value, white to red for what stands out. */
const VIRIDIS = [[68,1,84],[71,44,122],[59,81,139],[44,113,142],[33,144,141],[39,173,129],[92,200,99],[170,220,50],
  [253,231,37]].flat().map(x => x / 255);
const HEAT = [[235,238,240],[255,237,160],[254,217,118],[254,178,76],[253,141,60],[252,78,42],[227,26,28],[177,0,38],
  [100,0,30]].flat().map(x => x / 255);

let scene, programs, buffers, texture, turn, zoom, shift, first, layout = 'both', colour = 'index', waiting = false;

/* ---- reading ---- */
const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;

/* Corners are 16-bit parts of the box. */
function readMesh(mesh) {
  const part = new Uint16Array(bytes(mesh.corners)), corners = new Float32Array(part.length);
  for (let v = 0; v < part.length; v++) {
    corners[v] = mesh.low[v % 3] + part[v] / 65535 * (mesh.high[v % 3] - mesh.low[v % 3]);
  }
  const wide = corners.length / 3 > 65536;
  return {corners, faces: wide ? new Uint32Array(bytes(mesh.faces)) : new Uint16Array(bytes(mesh.faces)), wide};
}

function read(raw) {
  const floats = text => text === undefined ? null : new Float32Array(bytes(text));
  return {raw, spheres: floats(raw.spheres), mass: floats(raw.mass), protrusion: floats(raw.protrusion),
    mesh: raw.mesh ? readMesh(raw.mesh) : null};
}

/* ---- values and their scale ---- */
/* How far each corner of the shape is outside the first spheres. */
function findGaps() {
  const c = scene.mesh.corners, gap = new Float32Array(c.length / 3), s = new Float32Array(4 * first);
  const order = Array.from({length: first}, (_, k) => 4 * k).sort((p, q) => scene.spheres[p] - scene.spheres[q]);
  const widest = order.reduce((most, k) => Math.max(most, scene.spheres[k + 3]), 0);
  order.forEach((k, at) => s.set(scene.spheres.subarray(k, k + 4), 4 * at));
  let nearest = 0; /* of the corner before; from there outwards along x, as far as a sphere can reach */
  for (let v = 0; v < gap.length; v++) {
    const x = c[3 * v], y = c[3 * v + 1], z = c[3 * v + 2], from = nearest;
    let least = Infinity;
    for (let way = 4; way >= -4; way -= 8) {
      let k = way > 0 ? from : from - 4;
      for (; k >= 0 && k < s.length && least > 0 && way * (s[k] - x) < 4 * (least + widest); k += way) {
        const a = x - s[k], b = y - s[k + 1], d = z - s[k + 2], off = Math.sqrt(a * a + b * b + d * d) - s[k + 3];
        if (off < least) {
          least = off;
          nearest = k;
        }
      }
    }
    gap[v] = Math.max(0, least);
  }
  return gap;
}

/* Of each sphere the smallest cap that one of the largest spheres leaves outside itself: all that can be seen of it, and a
   little more than that. Halves the pixels to be drawn of a clump of many. */
function findCaps() {
  const s = scene.spheres, caps = new Float32Array(4 * first), at = Array.from({length: first}, (_, k) => 4 * k);
  const largest = [...at].sort((p, q) => s[q + 3] - s[p + 3]).slice(0, 1000);
  for (const k of at) {
    caps[k + 3] = -1;
    for (const i of largest) {
      const x = s[k] - s[i], y = s[k + 1] - s[i + 1], z = s[k + 2] - s[i + 2], d = Math.sqrt(x * x + y * y + z * z);
      const least = (s[i + 3] ** 2 - d * d - s[k + 3] ** 2) / (2 * d * s[k + 3]) - .001;
      if (d > 0 && least > caps[k + 3]) {
        caps.set([x / d, y / d, z / d, Math.min(1, least)], k);
      }
    }
  }
  return caps;
}

/* The largest one; lengths of the scene. */
const findProtrusion = () => scene.protrusion ? scene.protrusion.reduce((a, b) => Math.max(a, b), 0) / scene.raw.scale : 0;

const number = x => x === 0 ? '0' : Number(x.toPrecision(3)).toString();

/* The value of each sphere, and what the scale says. */
function findValues() {
  const n = scene.spheres.length / 4;
  if (colour === 'radius') {
    return {title: 'radius', values: Float32Array.from({length: n}, (_, k) => scene.spheres[4 * k + 3] * scene.raw.scale)};
  }
  if (colour === 'mass') {
    return {title: 'mass, kg', values: scene.mass};
  }
  if (colour === 'protrusion') {
    return {title: 'largest protrusion of a sphere, in the clump of all', values: scene.protrusion, low: 0};
  }
  return {title: 'index', values: Float32Array.from({length: n}, (_, k) => k + 1)};
}

function paint() {
  const surface = colour === 'surface', stops = surface ? HEAT : VIRIDIS;
  let title, low, high;
  if (surface) {
    const gaps = scene.mesh ? findGaps() : new Float32Array();
    const field = scene.raw.field, gap = gaps.reduce((a, b) => Math.max(a, b), 0);
    [title, low, high] = field ? ['distance from the other surface', 0, Math.max(gap, findProtrusion()) || 1]
      : ['gap: distance of the shape from the spheres', 0, gap || 1];
    fill(buffers.value, new Float32Array(scene.spheres.length / 4)); /* seen where there is no field */
    scene.most = high;
    fill(buffers.gap, gaps.map(x => x / high));
    high *= scene.raw.scale;
  } else {
    const found = findValues();
    title = found.title;
    low = found.low !== undefined ? found.low : found.values.reduce((a, b) => Math.min(a, b), Infinity);
    high = found.values.reduce((a, b) => Math.max(a, b), -Infinity);
    const span = high - low || 1;
    fill(buffers.value, found.values.map(x => (x - low) / span));
  }
  byId('title').textContent = title;
  byId('low').textContent = number(low);
  byId('high').textContent = number(high);
  const ramp = byId('ramp'), pen = ramp.getContext('2d'), shades = pen.createLinearGradient(0, 0, ramp.width, 0);
  for (let k = 0; k < 9; k++) {
    shades.addColorStop(k / 8, `rgb(${stops.slice(3 * k, 3 * k + 3).map(x => Math.round(255 * x)).join()})`);
  }
  pen.fillStyle = shades;
  pen.fillRect(0, 0, ramp.width, ramp.height);
}

/* ---- drawing ---- */
function compile(pair) {
  const program = gl.createProgram();
  pair.forEach((text, k) => {
    const shader = gl.createShader(k ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(gl.getProgramInfoLog(program));
  }
  return {program, at: name => gl.getUniformLocation(program, name)};
}

function fill(buffer, data, kind = gl.ARRAY_BUFFER) {
  gl.bindVertexArray(null);
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, data, gl.STATIC_DRAW);
}

function fillField(field) {
  gl.bindTexture(gl.TEXTURE_3D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, ...field.n, 0, gl.RED, gl.UNSIGNED_BYTE, new Uint8Array(bytes(field.values)));
  for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_R, gl.CLAMP_TO_EDGE]]) {
    gl.texParameteri(gl.TEXTURE_3D, name, value);
  }
}

/* One attribute of an array. */
function point(buffer, place, size, each) {
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
  gl.vertexAttribDivisor(place, each);
}

function begin(program, box) {
  const least = .95 * zoom * Math.min(box[2], box[3]), x = least / box[2], y = least / box[3];
  gl.useProgram(program.program);
  gl.viewport(...box);
  gl.uniformMatrix3fv(program.at('turn'), true, turn);
  gl.uniform4f(program.at('view'), x, y, shift[0] * x, shift[1] * y);
  gl.uniform3fv(program.at('stops'), colour === 'surface' ? HEAT : VIRIDIS);
}

function drawSpheres(box) {
  const p = programs.sphere, field = scene.raw.field;
  begin(p, box);
  gl.uniform1i(p.at('surface'), colour === 'surface' && field ? 1 : 0);
  if (colour === 'surface' && field) {
    gl.uniform3fv(p.at('low'), field.low.map(x => x - .5 * field.h));
    gl.uniform3fv(p.at('size'), field.n.map(x => x * field.h));
    gl.uniform2f(p.at('range'), field.range[0] / scene.most, field.range[1] / scene.most);
  }
  gl.bindVertexArray(buffers.ofSpheres);
  gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, first);
}

function drawMesh(box, alpha) {
  const p = programs.mesh, mesh = scene.mesh;
  begin(p, box);
  gl.uniform1i(p.at('surface'), colour === 'surface' ? 1 : 0);
  gl.uniform1f(p.at('alpha'), alpha);
  gl.bindVertexArray(buffers.ofMesh);
  const draw = () => gl.drawElements(gl.TRIANGLES, mesh.faces.length, mesh.wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, 0);
  if (alpha === 1) {
    draw();
    return;
  }
  gl.enable(gl.BLEND);
  if (scene.protrusion) { /* a closed one: what looks away is behind the spheres */
    gl.enable(gl.CULL_FACE);
  }
  gl.depthMask(false);
  draw();
  gl.depthMask(true);
  gl.disable(gl.CULL_FACE);
  gl.disable(gl.BLEND);
}

function draw() {
  waiting = false;
  const w = canvas.width, h = canvas.height, all = [0, 0, w, h];
  const shown = scene.mesh ? layout : 'clump', wide = w >= h;
  gl.clearColor(1, 1, 1, 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  if (shown === 'both') {
    drawSpheres(wide ? [0, 0, w >> 1, h] : [0, h >> 1, w, h >> 1]);
    drawMesh(wide ? [w >> 1, 0, w >> 1, h] : [0, 0, w, h >> 1], 1);
  } else if (shown === 'shape') {
    drawMesh(all, 1);
  } else {
    drawSpheres(all);
    if (shown === 'over') {
      drawMesh(all, .3);
    }
  }
}

function redraw() {
  if (!waiting && scene) {
    waiting = true;
    requestAnimationFrame(draw);
  }
}

/* ---- the scene shown ---- */
function offer(value, is) {
  const option = byId('colour').querySelector(`[value=${value}]`);
  option.hidden = option.disabled = !is;
  if (!is && colour === value) {
    colour = byId('colour').value = 'index';
  }
}

function say() {
  const n = scene.spheres.length / 4, mesh = scene.raw.mesh;
  let text = first === n ? `${n} ${n === 1 ? 'sphere' : 'spheres'}` : `${first} of ${n} spheres`;
  if (mesh) {
    const drawn = scene.mesh.faces.length / 3;
    text += `, shape of ${mesh.of} triangles` + (drawn < mesh.of ? `, drawn with ${drawn}` : '');
  }
  byId('count').textContent = text;
}

function show(which) {
  scene = read(scenes[which]);
  const n = first = scene.spheres.length / 4;
  byId('name').textContent = scene.raw.name;
  byId('first').max = n; /* before its value, which it bounds */
  byId('first').value = n;
  byId('slider').hidden = !scene.raw.ordered || n < 2;
  byId('layout').disabled = !scene.mesh;
  offer('mass', scene.mass);
  offer('protrusion', scene.protrusion);
  offer('surface', scene.mesh);
  fill(buffers.sphere, scene.spheres);
  fill(buffers.cap, findCaps());
  if (scene.mesh) {
    fill(buffers.corner, scene.mesh.corners);
    gl.bindVertexArray(buffers.ofMesh);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.face);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, scene.mesh.faces, gl.STATIC_DRAW);
  }
  if (scene.raw.field) {
    fillField(scene.raw.field);
  }
  paint();
  say();
  redraw();
}

/* ---- reports: a tile and a row for each scene ---- */
function open(which) {
  show(which);
  byId('viewer').scrollIntoView();
}

/* Drawn small before the viewer has its size. */
function fillTiles() {
  const tiles = byId('tiles');
  [canvas.width, canvas.height] = [150, 150];
  layout = 'clump';
  scenes.forEach((raw, which) => {
    const tile = document.createElement('button'), picture = document.createElement('canvas');
    [picture.width, picture.height] = [150, 150];
    show(which);
    draw();
    picture.getContext('2d').drawImage(canvas, 0, 0);
    tile.append(picture, raw.name);
    tile.dataset.scene = which;
    tile.addEventListener('click', () => open(which));
    tiles.append(tile);
  });
  layout = 'both';
}

/* Numbers by size, all else as text; empty fields last. */
function sort(table, column, up) {
  const text = row => row.cells[column].textContent, rows = [...table.tBodies[0].rows];
  rows.sort((a, b) => {
    const s = text(a), t = text(b), both = s !== '' && t !== '';
    return !both ? (s === '') - (t === '') : up * (isNaN(s) || isNaN(t) ? s.localeCompare(t) : s - t);
  });
  table.tBodies[0].append(...rows);
}

function listenToTable() {
  const table = byId('rows');
  [...table.tHead.rows[0].cells].forEach((cell, column) => cell.addEventListener('click', () => {
    cell.dataset.up = cell.dataset.up === '1' ? '-1' : '1';
    sort(table, column, Number(cell.dataset.up));
  }));
  for (const row of table.tBodies[0].rows) {
    if (gl && row.dataset.scene) {
      row.addEventListener('click', () => open(Number(row.dataset.scene)));
    }
  }
  byId('filter').addEventListener('input', e => {
    const words = e.target.value.toLowerCase().split(/\s+/), shown = new Set();
    for (const row of table.tBodies[0].rows) {
      row.hidden = !words.every(word => row.textContent.toLowerCase().includes(word));
      if (!row.hidden) {
        shown.add(row.dataset.scene);
      }
    }
    for (const tile of byId('tiles').children) {
      tile.hidden = !shown.has(tile.dataset.scene);
    }
  });
}

function start() {
  programs = {sphere: compile(SPHERE), mesh: compile(MESH)};
  buffers = {ofSpheres: gl.createVertexArray(), ofMesh: gl.createVertexArray()};
  for (const name of ['sphere', 'value', 'cap', 'corner', 'gap', 'face']) {
    buffers[name] = gl.createBuffer();
  }
  texture = gl.createTexture();
  gl.bindVertexArray(buffers.ofSpheres);
  point(buffers.sphere, 0, 4, 1);
  point(buffers.value, 1, 1, 1);
  point(buffers.cap, 2, 4, 1);
  gl.bindVertexArray(buffers.ofMesh);
  point(buffers.corner, 0, 3, 0);
  point(buffers.gap, 1, 1, 0);
  gl.enable(gl.DEPTH_TEST);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
}

/* ---- the camera ---- */
function reset() {
  /* x to the right and z up, seen from a little above and beside */
  turn = [1, 0, 0, 0, 0, 1, 0, -1, 0];
  rotate(1, -.5);
  rotate(0, .35);
  [zoom, shift] = [1, [0, 0]];
  redraw();
}

/* About the screen's axis x (0) or y (1). */
function rotate(axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), a = axis ? 2 : 1, b = axis ? 0 : 2;
  for (let k = 0; k < 3; k++) {
    const u = turn[3 * a + k], v = turn[3 * b + k];
    turn[3 * a + k] = c * u - s * v;
    turn[3 * b + k] = s * u + c * v;
  }
}

/* Pixels of the page that make the radius of the scene. */
const reach = () => {
  const both = layout === 'both' && scene.mesh, w = canvas.clientWidth, h = canvas.clientHeight;
  return .475 * zoom * Math.min(both && w >= h ? w / 2 : w, both && w < h ? h / 2 : h);
};

const held = new Map();

function move(event) {
  const before = held.get(event.pointerId), dx = before && event.clientX - before.x, dy = before && event.clientY - before.y;
  if (!before) {
    return;
  }
  if (held.size > 1) {
    const other = [...held].find(([id]) => id !== event.pointerId)[1];
    const apart = (x, y) => Math.hypot(x - other.x, y - other.y) || 1;
    zoom *= apart(event.clientX, event.clientY) / apart(before.x, before.y);
  }
  if (held.size > 1 || event.shiftKey || event.buttons & 2) {
    const part = held.size > 1 ? .5 : 1;
    shift = [shift[0] + part * dx / reach(), shift[1] - part * dy / reach()];
  } else {
    rotate(1, dx / 150);
    rotate(0, dy / 150);
  }
  held.set(event.pointerId, {x: event.clientX, y: event.clientY});
  redraw();
}

function listen() {
  const KEYS = {ArrowLeft: [1, -.1], ArrowRight: [1, .1], ArrowUp: [0, -.1], ArrowDown: [0, .1]};
  canvas.addEventListener('pointerdown', e => {
    canvas.setPointerCapture(e.pointerId);
    held.set(e.pointerId, {x: e.clientX, y: e.clientY});
  });
  canvas.addEventListener('pointermove', move);
  for (const end of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(end, e => held.delete(e.pointerId));
  }
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('dblclick', reset);
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    zoom *= Math.exp(-e.deltaY / 600);
    redraw();
  }, {passive: false});
  canvas.addEventListener('keydown', e => {
    if (KEYS[e.key]) {
      e.preventDefault();
      rotate(...KEYS[e.key]);
      redraw();
    }
  });
  byId('reset').addEventListener('click', reset);
  byId('layout').addEventListener('change', e => { layout = e.target.value; redraw(); });
  byId('colour').addEventListener('change', e => { colour = e.target.value; paint(); redraw(); });
  byId('first').addEventListener('input', e => {
    first = Number(e.target.value);
    fill(buffers.cap, findCaps());
    if (colour === 'surface') {
      paint();
    }
    say();
    redraw();
  });
  new ResizeObserver(() => {
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * devicePixelRatio));
    redraw();
  }).observe(canvas);
}

function refuse(why) {
  for (const id of ['canvas', 'controls', 'scale', 'hint']) {
    byId(id).hidden = true;
  }
  byId('message').textContent = why;
  byId('message').hidden = false;
}

if (!gl) {
  refuse('This browser shows no picture: it has no WebGL 2, or it is switched off. The tables on this page hold without it.');
} else if (scenes.length === 0) {
  refuse('No clump of these results was kept, so that there is none to show.');
} else {
  start();
  reset();
  if (byId('tiles')) {
    fillTiles();
  }
  listen();
  show(0);
}
if (byId('rows')) {
  listenToTable();
}
})();
