// The globe of a report: heights and layers that lie packed in the page, drawn by WebGL2. Without it, or on a
// browser that cannot unpack them, the section stays hidden and the pictures below say the same.
"use strict";
(() => {
  const root = document.getElementById("globe");
  const canvas = root.querySelector("canvas");
  const gl = "DecompressionStream" in window ? canvas.getContext("webgl2", { antialias: true }) : null;
  if (!gl) {
    document.querySelector('nav a[href="#globe"]')?.remove();
    return;
  }
  root.hidden = false;
  const index = JSON.parse(document.getElementById("globe-index").textContent);
  const { nx, ny } = index, cells = nx * ny;
  const part = (name) => root.querySelector(`[data-part="${name}"]`);
  const radians = Math.PI / 180;

  // ---- What lies in the page ---------------------------------------------------------------------------------

  /** Bytes of an element that holds them deflated and in base64. */
  async function unpack(id) {
    const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  /** Codes of 16 bits: differences along rows, all low bytes before all high ones. */
  function codes(bytes, width, height) {
    const count = width * height, out = new Uint16Array(count);
    for (let row = 0, at = 0; row < height; ++row) {
      let last = 0;
      for (let column = 0; column < width; ++column, ++at) {
        last = (last + (bytes[at] | (bytes[count + at] << 8))) & 65535;
        out[at] = last;
      }
    }
    return out;
  }

  const NOTHING = 65535;

  const OVER = 2;  // of a mask: what lies over the layer, such as ice, is seen

  /** Values of a layer, NaN where there is none, and which cells its map colours. */
  async function load(layer) {
    if (!layer.loaded) {
      layer.loaded = unpack(layer.id).then((bytes) => {
        const values = Float64Array.from(codes(bytes, nx, ny), (code) =>
          code === NOTHING ? NaN : layer.offset + layer.scale * code);
        return { values, shown: layer.masked ? bytes.subarray(2 * cells) : null };
      });
    }
    return layer.loaded;
  }

  function cellAt(latitude, longitude) {
    const column = Math.floor(((((longitude + 180) / 360) % 1) + 1) % 1 * nx);
    const row = Math.min(ny - 1, Math.max(0, Math.floor((latitude + 90) / 180 * ny)));
    return row * nx + column;
  }

  /** Middle of the cell of the file that the value is of. */
  const placeOf = (cell) => [index.latitude[Math.floor(cell / nx)], index.longitude[cell % nx]];

  // ---- Colours -----------------------------------------------------------------------------------------------

  const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));

  /** Colour of a value as the layer's map has it. */
  function colouring(layer) {
    const colours = layer.colours.map(rgb), paper = rgb(layer.paper);
    if (layer.names || layer.kind === "areas") {
      const of = new Map(layer.stops.map((value, at) => [value, colours[at]]));
      return (value) => of.get(value) || paper;
    }
    const { stops } = layer, last = stops.length - 1;
    return (value) => {
      if (Number.isNaN(value)) return paper;
      let at = 0;
      while (at < last - 1 && value >= stops[at + 1]) ++at;
      if (layer.kind === "classes") return colours[Math.min(at, colours.length - 1)];
      const share = Math.min(1, Math.max(0, (value - stops[at]) / (stops[at + 1] - stops[at])));
      return [0, 1, 2].map((c) => colours[at][c] + share * (colours[at + 1][c] - colours[at][c]));
    };
  }

  function coloured(layer, { values, shown }, ground) {
    const pixels = new Uint8Array(4 * cells), colour = colouring(layer);
    const sea = rgb(index.sea), land = rgb(index.land), over = layer.over && rgb(layer.over.colour);
    for (let cell = 0; cell < cells; ++cell) {
      const hidden = shown && !shown[cell], covered = over && shown[cell] === OVER;
      pixels.set(covered ? over : hidden ? (ground[cell] < 0 ? sea : land) : colour(values[cell]), 4 * cell);
      pixels[4 * cell + 3] = 255;
    }
    return pixels;
  }

  // ---- What is drawn -----------------------------------------------------------------------------------------

  const VERTEX = `#version 300 es
    precision highp float;
    in vec2 place;
    uniform highp sampler2D heights;
    uniform mat3 turn;
    uniform vec4 camera;  // focal length, aspect, distance, 1 / planet radius times exaggeration
    uniform float floorToo;
    out vec2 at;
    float height(vec2 p) {
      ivec2 size = textureSize(heights, 0);
      vec2 q = p * vec2(size) - 0.5;
      ivec2 a = ivec2(floor(q));
      vec2 f = q - vec2(a);
      #define H(i, j) texelFetch(heights, ivec2((a.x + i + size.x) % size.x, clamp(a.y + j, 0, size.y - 1)), 0).r
      return mix(mix(H(0, 0), H(1, 0), f.x), mix(H(0, 1), H(1, 1), f.x), f.y);
    }
    void main() {
      at = place;
      float latitude = (place.y - 0.5) * 3.14159265, longitude = (place.x - 0.5) * 6.2831853;
      vec3 up = vec3(cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude));
      float h = height(place);
      vec3 p = turn * up * (1.0 + camera.w * mix(max(h, 0.0), h, floorToo));
      float w = camera.z - p.z, near = 0.005, far = camera.z + 1.5;
      gl_Position = vec4(camera.x * p.x / camera.y, camera.x * p.y, ((w - near) / (far - near) * 2.0 - 1.0) * w, w);
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float;
    in vec2 at;
    uniform highp sampler2D heights;
    uniform sampler2D colours, marks;
    uniform mat3 turn;
    uniform vec2 spacing;  // of cells, m: along the equator, along meridians
    uniform float steepness;
    out vec4 colour;
    void main() {
      ivec2 size = textureSize(heights, 0);
      ivec2 c = clamp(ivec2(at * vec2(size)), ivec2(0), size - 1);
      #define H(i, j) texelFetch(heights, ivec2((c.x + i + size.x) % size.x, clamp(c.y + j, 0, size.y - 1)), 0).r
      float latitude = (at.y - 0.5) * 3.14159265, longitude = (at.x - 0.5) * 6.2831853;
      vec3 up = vec3(cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude));
      vec3 east = vec3(cos(longitude), 0.0, -sin(longitude)), north = cross(up, east);
      float wide = spacing.x * max(cos(latitude), 0.03);
      vec2 rise = vec2((H(1, 0) - H(-1, 0)) / (2.0 * wide), (H(0, 1) - H(0, -1)) / (2.0 * spacing.y));
      float strength = steepness * (H(0, 0) < 0.0 ? 0.35 : 1.0);
      vec3 normal = normalize(up - strength * (rise.x * east + rise.y * north));
      vec3 light = normalize(vec3(-0.45, 0.55, 0.75));
      float shade = dot(turn * normal, light), plain = dot(turn * up, light);
      vec3 base = texture(colours, at).rgb;
      vec4 mark = texture(marks, at);
      base = mix(base, mark.rgb / max(mark.a, 1e-3), mark.a);
      float lit = clamp(0.62 + 0.38 * plain + 0.75 * (shade - plain), 0.0, 1.25);
      colour = vec4(clamp(base * lit, 0.0, 1.0), 1.0);
    }`;

  function program() {
    const made = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    gl.useProgram(made);
    return made;
  }

  /** Corners of a mesh over the whole planet, and its triangles. */
  function mesh(columns, rows) {
    const corners = new Float32Array(2 * (columns + 1) * (rows + 1)), triangles = new Uint16Array(6 * columns * rows);
    for (let j = 0, at = 0; j <= rows; ++j)
      for (let i = 0; i <= columns; ++i, at += 2) corners.set([i / columns, j / rows], at);
    for (let j = 0, at = 0; j < rows; ++j)
      for (let i = 0; i < columns; ++i, at += 6) {
        const a = j * (columns + 1) + i, b = a + columns + 1;
        triangles.set([a, a + 1, b, b, a + 1, b + 1], at);
      }
    return { corners, triangles };
  }

  const shader = program();
  const uniform = (name) => gl.getUniformLocation(shader, name);
  const where = Object.fromEntries(["heights", "colours", "marks", "turn", "camera", "floorToo", "spacing", "steepness"]
    .map((name) => [name, uniform(name)]));
  const { corners, triangles } = mesh(256, 128);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
  const place = gl.getAttribLocation(shader, "place");
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, 2, gl.FLOAT, false, 0, 0);
  gl.enable(gl.DEPTH_TEST);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
  const textures = Object.fromEntries(["heights", "colours", "marks"].map((name, unit) => {
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.uniform1i(where[name], unit);
    return [name, unit];
  }));

  function fill(name, upload, linear, mipmaps) {
    gl.activeTexture(gl.TEXTURE0 + textures[name]);
    upload();
    const far = linear ? (mipmaps ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR) : gl.NEAREST;
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, far);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, linear ? gl.LINEAR : gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.REPEAT);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    if (mipmaps) gl.generateMipmap(gl.TEXTURE_2D);
  }

  // ---- Lines over the layers ---------------------------------------------------------------------------------

  const marks = document.createElement("canvas");
  marks.width = 2048;
  marks.height = 1024;
  const pen = marks.getContext("2d");

  function line(points, shift) {
    pen.beginPath();
    points.forEach(([longitude, latitude], at) => {
      const x = (longitude + 180) / 360 * marks.width + shift, y = (latitude + 90) / 180 * marks.height;
      if (at) pen.lineTo(x, y); else pen.moveTo(x, y);
    });
    pen.stroke();
  }

  /** At both edges where a line runs across one. */
  function lines(all, style, width) {
    pen.strokeStyle = style;
    for (const points of all) {
      pen.lineWidth = width(points);
      for (const shift of [0, -marks.width, marks.width]) line(points, shift);
    }
  }

  function arrows() {
    pen.strokeStyle = "#20262d";
    pen.lineWidth = 1.4;
    for (const [longitude, latitude, east, north] of index.wind || []) {
      const stretch = 1 / Math.max(0.15, Math.cos(latitude * radians)), k = 1.6;
      const x = (longitude + 180) / 360 * marks.width, y = (latitude + 90) / 180 * marks.height;
      const dx = k * east * stretch, dy = k * north, length = Math.hypot(dx, dy);
      if (length < 1) continue;
      const bx = dx / length * 5, by = dy / length * 5;
      pen.beginPath();
      pen.moveTo(x - dx, y - dy);
      pen.lineTo(x + dx, y + dy);
      pen.moveTo(x + dx - bx - by * 0.7, y + dy - by + bx * 0.7);
      pen.lineTo(x + dx, y + dy);
      pen.lineTo(x + dx - bx + by * 0.7, y + dy - by - bx * 0.7);
      pen.stroke();
    }
  }

  function drawMarks() {
    pen.clearRect(0, 0, marks.width, marks.height);
    pen.lineJoin = pen.lineCap = "round";
    const wants = (name) => part(name) && part(name).checked && !frame;
    if (wants("graticule")) {
      const steps = Array.from({ length: 12 }, (_, k) => -180 + 30 * k);
      lines(steps.map((longitude) => [[longitude, -80], [longitude, 80]]), "rgb(32 38 45 / 35%)", () => 1);
      lines([-60, -30, 0, 30, 60].map((latitude) => [[-180, latitude], [180, latitude]]), "rgb(32 38 45 / 35%)", () => 1);
    }
    if (wants("rivers"))
      for (const river of index.rivers)
        lines(river.slice(1).map((point, at) => [river[at], point]), "rgb(41 99 158)", ([from]) => 0.6 + 0.6 * from[2]);
    if (wants("plates"))
      for (const [colour, all] of Object.entries(index.boundaries)) lines(all, colour, () => 2.2);
    if (wants("wind")) arrows();
    fill("marks", () => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, marks), true, true);
  }

  // ---- View --------------------------------------------------------------------------------------------------

  const view = { latitude: 20, longitude: index.centre, distance: 3.4 };
  const FOCUS = 2.95;
  let layer = index.layers[0], ground = null, current = null, frame = null, month = 0, waiting = false;

  function turn() {
    const [sl, cl] = [Math.sin(view.longitude * radians), Math.cos(view.longitude * radians)];
    const [sp, cp] = [Math.sin(view.latitude * radians), Math.cos(view.latitude * radians)];
    // Rows: right, up, towards the viewer.
    return [[cl, 0, -sl], [-sp * sl, cp, -sp * cl], [cp * sl, sp, cp * cl]];
  }

  const raise = () => Number(part("exaggeration").value) / index.radius_m;

  function draw() {
    waiting = false;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const rows = turn();
    gl.uniformMatrix3fv(where.turn, true, rows.flat());
    gl.uniform4f(where.camera, FOCUS, width / height, view.distance, raise());
    gl.uniform1f(where.floorToo, part("floor").checked ? 1 : 0);
    gl.uniform2f(where.spacing, 2 * Math.PI * index.radius_m / nx, Math.PI * index.radius_m / ny);
    gl.uniform1f(where.steepness, 4 + 0.5 * Number(part("exaggeration").value));
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_SHORT, 0);
  }

  function redraw() {
    if (!waiting) requestAnimationFrame(draw);
    waiting = true;
  }

  /** Latitude and longitude under a point of the canvas, or null beside the globe. */
  function pick(x, y) {
    const box = canvas.getBoundingClientRect(), aspect = box.width / box.height;
    const ray = [(2 * (x - box.left) / box.width - 1) * aspect / FOCUS, (1 - 2 * (y - box.top) / box.height) / FOCUS, -1];
    let radius = 1, found = null;
    for (let round = 0; round < 4; ++round) {
      const a = ray[0] ** 2 + ray[1] ** 2 + 1, b = -2 * view.distance, c = view.distance ** 2 - radius ** 2;
      const inside = b * b - 4 * a * c;
      if (inside < 0) return found;
      const along = (-b - Math.sqrt(inside)) / (2 * a);
      const p = [ray[0] * along, ray[1] * along, view.distance - along], rows = turn();
      const v = [0, 1, 2].map((k) => (p[0] * rows[0][k] + p[1] * rows[1][k] + p[2] * rows[2][k]) / radius);
      found = [Math.asin(Math.max(-1, Math.min(1, v[1]))) / radians, Math.atan2(v[0], v[2]) / radians];
      if (!ground) return found;
      const height = ground[cellAt(...found)];
      radius = 1 + raise() * (part("floor").checked ? height : Math.max(0, height));
    }
    return found;
  }

  // ---- Words -------------------------------------------------------------------------------------------------

  const degrees = (value, letters) => `${Math.abs(value).toFixed(2)}° ${value < 0 ? letters[1] : letters[0]}`;

  function words(of, value) {
    if (Number.isNaN(value)) return "none";
    if (of.names) return of.names[of.stops.indexOf(value)] || String(value);
    const digits = of.kind === "areas" ? 0 : Math.max(0, Math.min(6, 4 - Math.ceil(Math.log10(Math.abs(value) + 1e-9))));
    return `${value.toFixed(digits)}${of.units ? ` ${of.units}` : ""}`;
  }

  function tell(latitude, longitude) {
    if (!current) return;
    const cell = cellAt(latitude, longitude), [north, east] = placeOf(cell);
    const over = layer.over && current.shown[cell] === OVER ? `, ${layer.over.name}` : "";
    part("value").textContent =
      `${degrees(north, "NS")}, ${degrees(east, "EW")}: ${layer.title} ${words(layer, current.values[cell])}${over}`;
  }

  function legend() {
    const box = part("legend");
    box.replaceChildren();
    if (layer.kind === "areas") return;
    const add = (colour, name) => {
      const item = document.createElement("span"), patch = document.createElement("i");
      patch.style.background = colour;
      item.append(patch, name.replaceAll("_", " "));
      box.append(item);
    };
    const shown = layer.names || layer.stops.map((stop) => String(+(stop * layer.factor).toPrecision(4)));
    shown.forEach((name, at) => {
      if (!layer.colours[at] || (layer.stops[at] < 0 && layer.stops[at] > -0.01)) return;
      add(layer.colours[at], name);
    });
    if (layer.over) add(layer.over.colour, layer.over.name);
    if (layer.shown_units) box.append(layer.shown_units);
  }

  // ---- Layers and frames -------------------------------------------------------------------------------------

  function setGround(values) {
    ground = values;
    fill("heights", () => gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, nx, ny, 0, gl.RED, gl.FLOAT,
      Float32Array.from(values)), false, false);
  }

  function paint(of, data) {
    const flat = Boolean(of.names) || of.kind === "areas";
    fill("colours", () => gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, nx, ny, 0, gl.RGBA, gl.UNSIGNED_BYTE,
      coloured(of, data, ground)), !flat, !flat);
  }

  /** A layer as it is in the chosen month, where it has months. */
  const inMonth = (one) => (month && index.months[one.name] ? index.months[one.name][month - 1] : one);

  async function show(name) {
    layer = inMonth(index.layers.find((one) => one.name === name) || index.layers[0]);
    const data = await load(layer);
    current = data;
    paint(layer, data);
    legend();
    part("layer").value = layer.name;
    part("value").textContent = layer.title;
    redraw();
  }

  /** A month of the layer, 0 for the year; layers without months stay as they are. */
  async function showMonth(number) {
    month = number;
    part("month-name").textContent = month ? index.month_names[month - 1] : "year";
    if (!frame) await show(layer.name);
  }

  /** A moment of the drift: its relief in place of the planet's. */
  async function showFrame(number) {
    frame = index.frames[number] || null;
    const relief = index.layers[0];
    const data = frame ? await load(frame) : await load(relief);
    setGround(data.values);
    layer = inMonth(index.layers.find((one) => one.name === part("layer").value));
    current = frame ? data : await load(layer);
    paint(frame ? relief : layer, current);
    part("layer").disabled = Boolean(frame);
    part("time").textContent = frame ? `${frame.time_myr} Myr` : "today";
    if (frame) layer = { ...relief, title: "Elevation" };
    legend();
    drawMarks();
    redraw();
  }

  // ---- Hands -------------------------------------------------------------------------------------------------

  function spin(east, north) {
    view.longitude = ((view.longitude + east + 540) % 360) - 180;
    view.latitude = Math.max(-89, Math.min(89, view.latitude + north));
    redraw();
  }

  function zoom(times) {
    view.distance = 1 + Math.max(0.06, Math.min(5, (view.distance - 1) * times));
    redraw();
  }

  const fingers = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId), now = [event.clientX, event.clientY];
    if (!before) {
      const found = pick(...now);
      if (found) tell(...found);
      return;
    }
    if (fingers.size === 1) {
      const scale = 60 * (view.distance - 1) / canvas.clientHeight;
      spin((before[0] - now[0]) * scale, (now[1] - before[1]) * scale);
    } else {
      const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const apart = (at) => Math.hypot(at[0] - other[0], at[1] - other[1]);
      zoom(apart(before) / Math.max(1, apart(now)));
    }
    fingers.set(event.pointerId, now);
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, (event) => {
      fingers.delete(event.pointerId);
      const found = pick(event.clientX, event.clientY);
      if (found) tell(...found);
    });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const step = 6 * (view.distance - 1);
    const does = {
      ArrowLeft: () => spin(-step, 0), ArrowRight: () => spin(step, 0), ArrowUp: () => spin(0, step),
      ArrowDown: () => spin(0, -step), "+": () => zoom(0.8), "-": () => zoom(1.25),
    }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
    tell(view.latitude, view.longitude);
  });

  for (const one of index.layers) part("layer").add(new Option(one.title, one.name));
  part("layer").addEventListener("change", () => show(part("layer").value));
  for (const name of ["exaggeration", "floor"]) part(name).addEventListener("input", redraw);
  for (const name of ["rivers", "plates", "wind", "graticule"]) {
    const box = part(name);
    if (name !== "graticule" && !(name === "plates" ? index.boundaries : index[name])) {
      box.parentElement.remove();
    } else {
      box.addEventListener("input", () => { drawMarks(); redraw(); });
    }
  }
  if (index.frames.length) {
    part("frame").max = index.frames.length;
    part("frame").value = index.frames.length;
    part("frame").addEventListener("input", () => showFrame(Number(part("frame").value)));
  } else {
    part("frame").parentElement.remove();
  }
  if (Object.keys(index.months).length) {
    part("month").addEventListener("input", () => showMonth(Number(part("month").value)));
  } else {
    part("month").parentElement.remove();
  }
  new ResizeObserver(redraw).observe(canvas);

  const ready = load(index.layers[0]).then(async ({ values }) => {
    setGround(values);
    drawMarks();
    await show(index.layers[0].name);
    draw();
    gl.finish();
    performance.mark("globe-first-frame");
  });

  /** For scripts of the page's reader, and for tests. */
  window.terraneGlobe = {
    ready,
    layers: index.layers.map((one) => one.name),
    months: Object.keys(index.months),
    async value(name, latitude, longitude, month = 0) {
      const cell = cellAt(latitude, longitude);
      const of = month ? index.months[name][month - 1] : index.layers.find((one) => one.name === name);
      const [north, east] = placeOf(cell);
      return { value: (await load(of)).values[cell], latitude: north, longitude: east, quantum: of.scale };
    },
    show, showFrame, showMonth, draw,
    view: () => ({ ...view }),
    look(latitude, longitude, distance = view.distance) {
      Object.assign(view, { latitude, longitude, distance });
      redraw();
    },
  };
})();
