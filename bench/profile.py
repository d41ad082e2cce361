"""Where the time of frames goes: the share of each stage, as a Markdown table, by the profiler perf.

usage: profile.py PROGRAM MODEL.. [-- FLAGS]     FLAGS: those of 'halflit bench' (default: --size 512x512 --threads 1 --frames 200)

A function belongs to the first stage in STAGES that names it; what none names is the rest, whose largest functions are listed.
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


def shares(program, model, flags, rest):
    """Share of each stage, percent."""
    with tempfile.TemporaryDirectory() as folder:
        data = f"{folder}/perf.data"
        subprocess.run(["perf", "record", "-q", "-F", "4000", "-o", data, program, "bench", model, *flags], check=True, stdout=subprocess.DEVNULL)
        report = subprocess.run(["perf", "report", "-i", data, "--no-children", "--stdio", "-s", "sym", "-g", "none"], check=True,
                                capture_output=True, text=True).stdout
    found = collections.Counter()
    for share, function in re.findall(r"^\s*([\d.]+)%\s+(.*\S)", report, re.M):
        stage = next((stage for stage, names in STAGES.items() if re.search(names, function)), REST)
        found[stage] += float(share)
        if stage == REST:
            rest[function] += float(share)
    return found


def nanoseconds_a_fragment(program, model, flags):
    """Median frame of 'halflit bench' over the fragments that a picture of the same size shades."""
    bench = subprocess.run([program, "bench", model, *flags], check=True, capture_output=True, text=True).stdout
    median_ms = float(re.search(r"median\s+([\d.]+) ms", bench).group(1))
    size = re.search(r"frames of (\d+x\d+)", bench).group(1)
    with tempfile.TemporaryDirectory() as folder:
        report = subprocess.run([program, "render", model, "--size", size, "-o", f"{folder}/p.png", "--report", "-"], check=True,
                                capture_output=True, text=True).stdout
    return 1e6 * median_ms / json.loads(report)["fragments_shaded"]


def main():
    arguments = sys.argv[1:]
    cut = arguments.index("--") if "--" in arguments else len(arguments)
    program, *models = arguments[:cut]
    flags = arguments[cut + 1:] or ["--size", "512x512", "--threads", "1", "--frames", "200"]
    if not models:
        sys.exit(__doc__)
    rest = collections.Counter()
    columns = [shares(program, model, flags, rest) for model in models]
    rows = [(stage, [f"{column[stage]:.0f}" for column in columns]) for stage in [*STAGES, REST]
            if any(column[stage] >= 1 for column in columns)]
    rows.append(("ns a fragment", [f"{nanoseconds_a_fragment(program, model, flags):.0f}" for model in models]))
    print("| | " + " | ".join(pathlib.Path(model).stem for model in models) + " |\n|---|" + "---:|" * len(models))
    for name, cells in rows:
        print(f"| {name} | " + " | ".join(cells) + " |")
    print("\nrest: " + ", ".join(f"{name} {share / len(models):.1f}" for name, share in rest.most_common(6)), file=sys.stderr)


main()
