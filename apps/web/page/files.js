// Models and environments that a visitor drops or opens. They never leave the page. The worker reads them.
const kModelName = /\.(glb|gltf|stl|ply|obj|off|3mf)$/i, kSkyName = /\.(hdr|pfm)$/i;

function files_of_entry(entry, folder) {
  if (entry.isFile) return new Promise((resolve) => entry.file((file) => resolve([{ name: folder + file.name, file }]), () => resolve([])));
  const reader = entry.createReader(), found = [];
  const more = async () => {
    const entries = await new Promise((resolve) => reader.readEntries(resolve, () => resolve([])));
    if (entries.length === 0) return found;
    for (const inner of entries) found.push(...(await files_of_entry(inner, `${folder}${entry.name}/`)));
    return more();
  };
  return more();
}

// Files of a drop, those in folders by their paths.
async function dropped_files(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (entries.length === 0) return [...transfer.files].map((file) => ({ name: file.name, file }));
  return (await Promise.all(entries.map((entry) => files_of_entry(entry, "")))).flat();
}

// {files: [{name, file}], model, sky}: what of them to draw. Control characters in names would not pass through a link or a command line.
function chosen_of(list) {
  const files = list.map(({ name, file }) => ({ name: name.replace(/[\x00-\x1f\x7f]/g, "_"), file }));
  const named = (pattern) => files.map((file) => file.name).filter((name) => pattern.test(name)).sort((a, b) => a.split("/").length - b.split("/").length)[0];
  return { files, model: named(kModelName), sky: named(kSkyName) };
}

// The files, and those of `more`; a new file replaces one of the same name.
function with_files(files, more) {
  return [...files.filter((file) => !more.some((other) => other.name === file.name)), ...more];
}
