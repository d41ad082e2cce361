// Turning, moving and zooming of the view by mouse, touch and keys. Views are {position, target, fov} in the scene's units, with +y up.
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const plus = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length_of = (a) => Math.hypot(...a);
const unit = (a) => a.map((x) => x / (length_of(a) || 1));

function turned(view, azimuth, elevation) {
  const offset = subtract(view.position, view.target), distance = length_of(offset);
  if (distance === 0) return view;
  const limit = (89 * Math.PI) / 180;
  const el = Math.max(-limit, Math.min(limit, Math.atan2(offset[1], Math.hypot(offset[0], offset[2])) + elevation));
  const az = Math.atan2(offset[0], offset[2]) + azimuth;
  const direction = [Math.sin(az) * Math.cos(el), Math.sin(el), Math.cos(az) * Math.cos(el)];
  return { ...view, position: plus(view.target, direction, distance) };
}

// radius: of the scene. The distance stays between a thousandth and a thousand times of it, as in the window.
function nearer(view, factor, radius) {
  const offset = subtract(view.position, view.target), distance = length_of(offset);
  if (distance === 0) return view;
  const next = Math.max(radius * 1e-3, Math.min(radius * 1e3, distance / factor));
  return { ...view, position: plus(view.target, offset, next / distance) };
}

// Points at the target's distance follow the pointer: right and down are shares of the picture's height.
function moved(view, right, down) {
  const back = subtract(view.position, view.target), sideways = unit(cross([0, 1, 0], back)), up = unit(cross(back, sideways));
  const height = 2 * length_of(back) * Math.tan((view.fov * Math.PI) / 360);
  const by = plus(sideways.map((x) => -x * right * height), up, down * height);
  return { ...view, position: plus(view.position, by), target: plus(view.target, by) };
}

// change((view, radius) => view) is called for each motion; radius is the scene's.
function attach_orbit(element, change) {
  const pointers = new Map();
  const kTurn = 2 * Math.PI;  // for a motion across the element's width
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  for (const kind of ["pointerup", "pointercancel"]) element.addEventListener(kind, (event) => pointers.delete(event.pointerId));
  element.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last.x, dy = event.clientY - last.y;
    if (dx === 0 && dy === 0) return;
    const box = element.getBoundingClientRect();
    if (pointers.size === 1) {
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      const moves = event.buttons === 2 || event.shiftKey;
      change((view) => (moves ? moved(view, dx / box.height, dy / box.height) : turned(view, (-dx / box.width) * kTurn, (dy / box.width) * kTurn)));
      return;
    }
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const before = Math.hypot(last.x - other.x, last.y - other.y), after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const factor = before > 0 ? Math.max(0.5, Math.min(2, after / before)) : 1;
    change((view, radius) => nearer(moved(view, dx / 2 / box.height, dy / 2 / box.height), factor, radius));
  });
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    change((view, radius) => nearer(view, Math.exp(-Math.max(-200, Math.min(200, event.deltaY)) / 500), radius));
  }, { passive: false });
  element.addEventListener("keydown", (event) => {
    const step = Math.PI / 24;
    const arrow = (x, y) => (view) => (event.shiftKey ? moved(view, x / 24, -y / 24) : turned(view, x * step, y * step));
    const keys = {
      ArrowLeft: arrow(-1, 0), ArrowRight: arrow(1, 0), ArrowUp: arrow(0, 1), ArrowDown: arrow(0, -1),
      "+": (view, radius) => nearer(view, 1.1, radius), "-": (view, radius) => nearer(view, 1 / 1.1, radius),
    };
    if (!(event.key in keys)) return;
    event.preventDefault();
    change(keys[event.key]);
  });
}
