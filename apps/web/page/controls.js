// The form and the state, each made from the other.
const form = document.getElementById("controls");
const is_slider = (input) => input.type === "range";

// An option for a value that the page's lists lack, such as a dropped file.
function ensure_option(select, value) {
  if (![...select.options].some((option) => option.value === String(value))) select.add(new Option(value, value));
}

function say_value(input, text) {
  const output = input.parentElement.querySelector("output");
  if (output) output.textContent = text;
}

function show_lights(state, on_change) {
  const lights = lights_of(state), box = document.getElementById("lights");
  const count = document.getElementById("light_count");
  count.value = lights.length;
  say_value(count, lights.length);
  if (box.children.length === lights.length && box.contains(document.activeElement)) return;
  box.replaceChildren(...lights.map((light, i) => {
    const part = document.createElement("div");
    part.className = "light";
    part.setAttribute("role", "group");
    part.setAttribute("aria-label", `Light ${i + 1}`);
    const slider = (key, min, max, step) => {
      const label = document.createElement("label"), input = document.createElement("input"), output = document.createElement("output");
      Object.assign(input, { type: "range", min, max, step, value: light[key] });
      output.textContent = light[key];
      input.addEventListener("input", () => {
        output.textContent = input.value;
        on_change(i, key, +input.value);
      });
      label.append(key, input, output);
      return label;
    };
    const label = document.createElement("label"), color = document.createElement("input");
    Object.assign(color, { type: "color", value: light.color });
    color.addEventListener("input", () => on_change(i, "color", color.value));
    label.append("colour", color);
    part.append(slider("azimuth", -180, 180, 5), slider("elevation", -90, 90, 5), slider("intensity", 0, 3, 0.05), label);
    return part;
  }));
}

function show_state(state) {
  for (const input of form.elements) {
    if (!Object.hasOwn(kDefaults, input.name)) continue;
    const value = state[input.name];
    if (input.type === "checkbox") input.checked = value;
    else if (input.tagName === "SELECT") {
      ensure_option(input, value);
      input.value = value;
    } else if (value !== "") input.value = value;
  }
  const model = lobe_model(state.lobe), lobe = lobe_of(state), row = (name) => form.querySelector(`label[data-for="${name}"]`);
  form.wrap.disabled = !model?.takes_wrap;
  form.power.disabled = !model;
  form.normalize.disabled = !model || model.normalize;  // the name's own
  for (const name of ["wrap", "power", "normalize"]) row(name).classList.toggle("off", form[name].disabled);
  if (lobe) {
    form.wrap.value = lobe.wrap;
    form.power.value = lobe.power;
    form.normalize.checked = lobe.normalize;
  }
  say_value(form.wrap, lobe ? digits(lobe.wrap, 3) : "");
  say_value(form.power, lobe ? digits(lobe.power, 3) : "");
  say_value(form.rotate, `${state.rotate}°`);
  say_value(form.sun_size, `${state.sun_size}°`);
  say_value(form.sh_order, state.sh_order || "auto");
  say_value(form.exposure, exposure_text(state.exposure));
  say_value(form.time, `${digits(state.time, 3)} s`);
}

// The state after a change of one control.
function state_of_control(state, input) {
  const value = input.type === "checkbox" ? input.checked : is_slider(input) || typeof kDefaults[input.name] === "number" ? +input.value : input.value;
  const next = { ...state, [input.name]: value };
  if (input.name === "lobe") next.power = "";  // the name's own again
  const model = lobe_model(state.lobe);
  if (input.name === "power" && model && value === power_of(model, lobe_of(state).wrap)) next.power = "";
  if (input.name === "lobe" && !value) next.normalize = false;
  if (input.name === "scene") Object.assign(next, { view: "", time: 0 });
  if (input.name === "env" && value !== "sky" && value !== "studio") next.show_env = false;
  if (input.name === "show_env" && value && !next.env) next.env = "sky";
  return next;
}
