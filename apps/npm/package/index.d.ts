/// <reference lib="esnext.disposable" />

/** A Blob, a Response, or another object that gives its bytes. */
export interface BytesSource {
  arrayBuffer(): Promise<ArrayBuffer>;
}
/** Bytes of a file. A text is UTF-8. A Response that is not `ok`, `null` and `undefined` mean that there is no such file. */
export type FileSource = ArrayBuffer | ArrayBufferView | string | BytesSource | null | undefined;
/** Files beside the model, by the names that it gives: its buffers and textures. Or a function that is asked for each that is missing. */
export type Files = Record<string, FileSource> | Map<string, FileSource> | ((name: string) => FileSource | Promise<FileSource>);
/** The model's bytes (glTF, GLB, STL, PLY, OBJ, OFF, 3MF), or the name of a built-in scene: "demo", "sphere:5000", "lights:16". */
export type ModelSource = ArrayBuffer | ArrayBufferView | BytesSource | "demo" | `sphere:${number}` | `lights:${number}`;

/** A picture's options: those of the program's command line. */
export interface RenderOptions extends FlagOptions {
  /** Size in pixels, both or none. */
  width?: number;
  height?: number;
  /** More flags, as on the command line: "--view iso --samples 8". */
  flags?: string | string[];
}

export interface LoadOptions extends RenderOptions {
  files?: Files;
  /** The model's name, for messages; its folder is where the names of `files` begin. */
  name?: string;
}

/** As that of `halflit render --report`; docs/answers/report.txt describes it. */
export interface Report {
  schema: string;
  halflit: string;
  pixel_epoch: number;
  size: [number, number];
  pixel_hash: string;
  isa: string;
  samples: number;
  load_ms: number;
  prepare_ms: number;
  render_ms: number;
  triangles_drawn: number;
  warnings: string[];
  [key: string]: unknown;
}

/** As `halflit info --json` prints it; docs/answers/info.txt describes it. */
export interface Info {
  schema: string;
  file?: Record<string, unknown>;
  drawn: Record<string, number>;
  bounds: { min: [number, number, number]; max: [number, number, number] } | null;
  measures: Record<string, unknown>;
  parts: Array<Record<string, unknown>>;
  cameras: string[];
  animations: Array<{ name: string; end_s: number; channels: number }>;
  warnings: string[];
  [key: string]: unknown;
}

/** Uint8Array, from TypeScript 5.7 on with an ArrayBuffer, as Response, Blob and ImageData want it. */
export type Bytes = ReturnType<Uint8ArrayConstructor["of"]>;
export type Pixels = ReturnType<Uint8ClampedArrayConstructor["of"]>;

export class Picture {
  private constructor();
  readonly width: number;
  readonly height: number;
  /** RGBA, rows from the top, not multiplied by alpha. */
  readonly pixels: Pixels;
  /** The hash that the program prints for these pixels. */
  readonly hash: string;
  readonly report: Report;
  /** The file of the picture. */
  png(): Bytes;
  encode(format: "png" | "jpg" | "jpeg" | "bmp" | "tga"): Bytes;
}

/** Flags of a command by their names. */
export type CallOptions = Record<string, unknown>;

/** What a call tells. */
export interface Answer {
  /** false: a view with a fault, versions that differ, a blank picture. */
  good: boolean;
  /** Lines for people: faults first. */
  notes: string[];
  report: Record<string, unknown>;
  /** null where the call draws none. */
  picture: Picture | null;
}

/** A loaded model. It stays prepared from one picture to the next. */
export class Scene implements Disposable {
  private constructor();
  /** Draws it by the options of load() and these. */
  render(options?: RenderOptions | null): Promise<Picture>;
  /** Describes it; `parts`: with measures of each part. */
  info(options?: (RenderOptions & { parts?: boolean }) | null): Promise<Info>;
  /** The text that `halflit info` prints; `json`: as one JSON object. */
  describe(options?: (RenderOptions & { parts?: boolean; json?: boolean }) | null): Promise<string>;
  /** One of the calls of the engine by its name: look, section, certify, measure, explain, compare, info. `given`: the flags of the program's
   *  command. */
  call(name: string, given?: CallOptions | null): Promise<Answer>;
  /** Labelled views on one sheet, and what each shows of each part. */
  look(given?: CallOptions | null): Promise<Answer>;
  /** The same with planes that cut, as "x=50%". */
  section(section: string | string[], given?: CallOptions | null): Promise<Answer>;
  /** Which triangles no view shows. */
  certify(given?: CallOptions | null): Promise<Answer>;
  /** Box, area, volume and bodies of the model and of its parts. */
  measure(given?: CallOptions | null): Promise<Answer>;
  /** What made a pixel, [x, y], or each of several. */
  explain(pixel: [number, number] | Array<[number, number]>, given?: CallOptions | null): Promise<Answer>;
  /** The model and another of the scene's files. */
  compare(other: string, given?: CallOptions | null): Promise<Answer>;
  /** Gives its memory back, as `using scene = await load(model)` does at the end of its block. */
  free(): void;
  [Symbol.dispose](): void;
}

/** A picture of MujocoRenderer. */
export type MujocoColors = Omit<Picture, "report"> & {
  /** look: the release that was asked for. */
  readonly report: { pixel_hash: string; size: [number, number]; samples: 1 | 4; look: string };
};

export interface MujocoOptions {
  /** Both or none. Default: 320 x 240. */
  width?: number;
  height?: number;
  /** Samples a pixel, for colours (default: 4 if the model's offsamples is above 1, else 1). */
  samples?: 1 | 4;
  /** Colours (default: true). Depth and segmentation alone take a tenth of the time. */
  rgb?: boolean;
  /** Distances along the view, one a pixel, rows from the top; the far plane's where nothing is. */
  depth?: boolean;
  /** objid and objtype (mjtObj), two a pixel; -1, -1 where nothing is. */
  segmentation?: boolean;
}

/** null: not asked for. */
export interface MujocoPlanes<Options extends MujocoOptions = MujocoOptions> {
  picture: Options extends { rgb: infer Rgb } ? (Rgb extends true ? MujocoColors : null)
    : "rgb" extends keyof Options ? MujocoColors | null : MujocoColors;
  depth: Options extends { depth: true } ? Float32Array : Float32Array | null;
  segmentation: Options extends { segmentation: true } ? Int32Array : Int32Array | null;
}

/** Draws scenes of the simulator MuJoCo (mujoco-js or @mujoco/mujoco) as its own classic renderer does. It copies the model's shapes and
 *  textures when it is made. */
export class MujocoRenderer implements Disposable {
  private constructor();
  /** mujoco: the simulator's module; model: an MjModel of it. look: the release whose pictures are made, "2.2" or later, below 4 (default:
   *  the module's). */
  static create(
    mujoco: { MjvScene: unknown; mj_versionString?: () => string }, model: { vis: unknown; stat: unknown }, options?: { look?: string } | null,
  ): Promise<MujocoRenderer>;
  /** Draws what mjv_updateScene() left in an MjvScene of the same module. */
  render<const Options extends MujocoOptions = {}>(
    scene: { ngeom: number; nlight: number; geoms: unknown; lights: unknown; camera: unknown; flags: unknown }, options?: Options | null,
  ): MujocoPlanes<Options>;
  /** Gives its memory back. */
  free(): void;
  [Symbol.dispose](): void;
}

/** `code` is the exit code that the program has for the error. */
export class HalflitError extends Error {
  constructor(message: string, code: number);
  readonly code: number;
}

/** WebAssembly.Module, where the types of the host have it. */
export type CompiledCode = typeof globalThis extends { WebAssembly: { Module: { prototype: infer Module } } } ? Module : object;
/** A compiled module, its bytes, or a Response with them. */
export type Code = CompiledCode | ArrayBuffer | ArrayBufferView | BytesSource;

export interface InitOptions {
  /** halflit.wasm. */
  wasm?: Code | Promise<Code>;
  /** halflit_wasm128.wasm, the kernels with SIMD. With `wasm` and without this, the scalar kernels draw. */
  wasm128?: Code | Promise<Code>;
  /** Whether to take the kernels with SIMD (default: where the host has it). */
  simd?: boolean;
}

/** Starts the module, which the first scene does otherwise. With options, {} too: a new one, for scenes that are loaded from
 *  then on; the old one and its memory go with its last scene. */
export function init(options?: InitOptions | null): Promise<{ version: string; pixelEpoch: number; isa: string }>;
/** Loads a model. */
export function load(source: ModelSource, options?: LoadOptions | null): Promise<Scene>;
/** Loads a model, draws it and frees it. */
export function render(source: ModelSource, options?: LoadOptions | null): Promise<Picture>;
/** Bytes of memory that the module has taken. They are given back with the module: see init(). */
export function memory(): Promise<number>;
export const version: string;
/** Releases with the same number have the same pixels. */
export const pixelEpoch: number;
