"""Where the time of frames goes: the share of each stage in percent, as a Markdown table, by the profiler perf.

usage: ./dev bench --profile MODEL.. [-- FLAGS]
  FLAGS: those of 'halflit bench' (default: --size 512x512 --threads 1 --frames 200)

A function belongs to the first stage in STAGES that names it. What none names is the rest, whose largest functions are listed. The start of
the program counts as well; many frames make it small. The last row is the least frame over the fragments that it shades.
"""

import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

STAGES = {
    "shadow maps": r"rasterize_depth|::distances|ShadowMaps",
    "visibility (rasterize, collect)": r"::rasterize\b|::collect\b|draw_visibility|::cover",
    "joining fragments": r"PictureTile::join",
    "interpolation": r"::interpolate\b",
    "textures": r"filter_texels|make_taps|sum_of_plain|sum_of_probes|make_probes|fetch_surfaces",
    "lights and their shadows": r"add_lights|add_ggx_lights|hidden_share|cast_shadow",
    "surroundings: bands": r"environment_light",
    "surroundings: reflections": r"blurred_radiance|add_surroundings|mirror",
    "directions, sums": r"find_directions|::shade\b|shade_block|combine",
    "tone, samples, codes": r"write_whole|write_samples|resolve|tone_block|encode|part_of|light_of|cover_backing",
    "lists of fragments": r"PictureTile::",
    "geometry (transform, bin, records)": r"::transform\b|bin_triangles|ChunkBuilder|vertex_records|VertexRecords|Culler|ViewGeometry",
    "system (pages, memory)": r"\[k\]|mem(set|move|cpy)",
}
REST = "rest"
USUAL_FLAGS = ["--size", "512x512", "--threads", "1", "--frames", "200"]


def output_of(command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{result.stderr}profile: {command[0]} failed")
    return result.stdout


def shares(bench, rest):
    """Share of each stage in percent, and the frames' report."""
    with tempfile.TemporaryDirectory() as folder:
        data = f"{folder}/perf.data"
        report = json.loads(output_of(["perf", "record", "-q", "-F", "4000", "-o", data, *bench, "--json"]))
        functions = output_of(["perf", "report", "-i", data, "--no-children", "--stdio", "-s", "sym", "-g", "none"])
    found = collections.Counter()
    for share, function in re.findall(r"^\s*([\d.]+)%\s+(.*\S)", functions, re.M):
        stage = next((stage for stage, names in STAGES.items() if re.search(names, function)), REST)
        found[stage] += float(share)
        if stage == REST:
            rest[function] += float(share)
    return found, report


def main():
    arguments = sys.argv[2:]
    cut = arguments.index("--") if "--" in arguments else len(arguments)
    models, flags = arguments[:cut], arguments[cut + 1:] or USUAL_FLAGS
    if not models or any(model.startswith("-") for model in models):
        sys.exit(__doc__)
    rest = collections.Counter()
    columns = [shares([sys.argv[1], "bench", model, *flags], rest) for model in models]
    print("| | " + " | ".join(pathlib.Path(model).stem for model in models) + " |\n|---|" + "---:|" * len(models))
    for stage in [*STAGES, REST]:
        if any(found[stage] >= 1 for found, _ in columns):
            print(f"| {stage} | " + " | ".join(f"{found[stage]:.0f}" for found, _ in columns) + " |")
    print("| ns a fragment | " + " | ".join(f"{1e6 * report['min_ms'] / report['fragments_shaded']:.0f}" for _, report in columns) + " |")
    print("\nrest: " + ", ".join(f"{name} {share / len(models):.1f}" for name, share in rest.most_common(6)), file=sys.stderr)


main()
