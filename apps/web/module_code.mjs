// Forms of the modules' code for the page and the npm package.

// Emscripten's code around a module, as an expression: the function halflit_module. It asks the names below where it runs. The engine hands
// it the module, so to it every host is the same, which has none of them.
const kHosts = ["window", "importScripts", "process", "require", "document", "__filename", "exports", "module", "define"];

export const module_code = (glue) => `((${kHosts.join(", ")}) => {
${glue}
return halflit_module;
})()`;

// A module of JavaScript as a part of one script, which has what it imports ahead of it.
export function part_of_script(text) {
  const part = text.replace(/^import [^;]*;\n/gm, "").replace(/^export (?=(async function|function|class|const|let) )/gm, "");
  if (/^(import|export)\b/m.test(part)) throw new Error("an import or export that a part of a script cannot have");
  return part;
}
