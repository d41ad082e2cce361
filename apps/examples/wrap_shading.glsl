// Wrapped diffuse light for GLSL (ES 3.00, or 1.30 and newer): copy what you need. wrap_shading.hlsl has the same functions for HLSL.
// MIT licence, as all of halflit. The formulas come from [Green04], [Valve06], [SNY11] and [McA13]; sh/README.md lists these sources.
//
// x is dot(N, L), with unit vectors N, the surface normal, and L, towards the light. A lobe f(x) is the light that a white surface reflects
// of a light of colour 1. There is no division by pi: f(1) = 1, as is usual for the colours of lights in engines.
//
//     float x = dot(normal, to_light);
//     vec2 seen = shadow_tap(behind, wrap_fade_distance(w, radius), x, w);        // no shadow: vec2(1.0, 1.0)
//     vec3 direct = light_color * wrap_shadowed(wrap_lobe(x, w, n), x, seen);
//     vec3 sky = wrap_sky(sh, normal, wrap_bands(w, n));
//     vec3 color = albedo * wrap_scale(w, n) * (direct + sky);                    // without wrap_scale: not normalized

// The family that holds all others. w in [0, 1] is the wrap: light reaches surfaces with x > -w. n >= 0 is the power; below 1 the lobe has
// an edge at its end. At x <= -w the lobe is 0 for every n. The clamp must be on the sum x + w: a clamp on x alone would never wrap.
float wrap_lobe(float x, float w, float n) {
    float t = clamp((x + w) / (1.0 + w), 0.0, 1.0);
    return t > 0.0 ? pow(t, n) : 0.0;
}

// Factor that makes the mean of a lobe over all directions of light the same as Lambert's. It must be applied to direct light and to the
// sky alike, or to neither. Single directions may still reflect more than arrives: the factor is above 1 if n > 1 + 2 w.
float wrap_scale(float w, float n) { return (n + 1.0) / (2.0 * (1.0 + w)); }

// Members with a name. Lambert's lobe is w = 0, n = 1.
float lambert(float x) { return max(x, 0.0); }
// Green's wrap: n = 1. It has a visible edge where it ends.
float green_wrap(float x, float w) { return max(x + w, 0.0) / (1.0 + w); }
// Half-Lambert: w = 1, n = 1. Exactly Lambert's surface under a hemisphere of constant light.
float half_lambert(float x) { return 0.5 * x + 0.5; }
// Valve's square of it: w = 1, n = 2. Exactly Lambert's surface under a hemisphere of light 2 cos^2. No pow; all of its light is in three
// bands of spherical harmonics.
float valve_lobe(float x) {
    float t = 0.5 * x + 0.5;
    return t * t;
}
// Sloan's generalised lobe: w = a, n = 1 + a. Lambert's at a = 0, Valve's at a = 1; it keeps the cosine's curvature at its peak, and for
// a > 0 it ends without an edge.
float sloan_lobe(float x, float a) { return wrap_lobe(x, a, 1.0 + a); }
// McAuley's form: any wrap and power, normalized.
float mcauley_lobe(float x, float w, float n) { return wrap_scale(w, n) * wrap_lobe(x, w, n); }

// Factors of the bands 0, 1 and 2 of the lobe, for wrap_sky. The 1/pi of irradiance is inside: Lambert has 1, 2/3, 1/4. The exact form for
// every w and n; Sloan's lobe is wrap_bands(a, 1.0 + a). Compute them once per material.
vec3 wrap_bands(float w, float n) {
    float f0 = 2.0 * (1.0 + w) / (n + 1.0);
    float g1 = (n + 1.0 - w) / (n + 2.0);
    float g2 = (n - 3.0 * w * g1) / (n + 3.0);
    return vec3(f0, f0 * g1, f0 * g2);
}

// Light of a sky that a white surface with this lobe reflects. sh: the sky's radiance in nine orthonormal real spherical harmonics, (l, m)
// at l * l + l + m, with z as the polar axis and the Condon-Shortley sign, by which odd m have a minus. For coefficients without that sign,
// turn the four minus signs before sh[1], sh[3], sh[5] and sh[7] into plus. Near a strong light three bands ring below 0: hence the max.
vec3 wrap_sky(vec3 sh[9], vec3 normal, vec3 bands) {
    float x = normal.x;
    float y = normal.y;
    float z = normal.z;
    vec3 band0 = sh[0] * 0.282094792;                                                 // sqrt(1 / pi) / 2
    vec3 band1 = (sh[2] * z - sh[1] * y - sh[3] * x) * 0.488602512;                   // sqrt(3 / pi) / 2
    vec3 band2 = (sh[4] * (x * y) - sh[5] * (y * z) - sh[7] * (x * z)) * 1.092548431  // sqrt(15 / pi) / 2
                 + sh[6] * (0.946174696 * z * z - 0.315391565)                        // sqrt(5 / pi) / 4 * (3 z^2 - 1)
                 + sh[8] * (0.546274215 * (x * x - y * y));                           // sqrt(15 / pi) / 4
    return max(band0 * bands.x + band1 * bands.y + band2 * bands.z, vec3(0.0, 0.0, 0.0));
}

// Soft-split shadows. A shadow map cuts a wrapped lobe off at x = 0, because there the body hides the light from itself: a visible step.
// So the lobe is split. Lambert's part takes the shadow as it is. The rest, the wrapped light, fades with the distance to the blocker.
//
// Distance to the blocker from which on wrapped light is 0. radius: half the size of the object, in the units of `behind`.
float wrap_fade_distance(float w, float radius) { return 2.25 * w * radius; }

// Shares of light that are left, for one texel of the shadow map: x for Lambert's part, y for wrapped light. Average them over the texels
// of a filter. behind: distance of the surface from the light, less the bias, less the map's distance; above 0 the texel hides the surface.
// Where the surface turns away, its own thickness towards the light is not counted: a share `own` of the fade distance.
vec2 shadow_tap(float behind, float fade_distance, float x, float w) {
    float own = min(max(-x, 0.0) * 0.888888889 / max(w, 1e-6), 0.888888889);  // 8/9
    float u = clamp((behind / max(fade_distance, 1e-6) - own) / (1.0 - own), 0.0, 1.0);
    float left = (1.0 - u) * (1.0 - u) * (1.0 + 2.0 * u);
    return behind > 0.0 ? vec2(0.0, left) : vec2(1.0, 1.0);
}

// The lobe f at x under a shadow; `seen` as from shadow_tap. f must not be normalized yet. Highlights take seen.x alone.
float wrap_shadowed(float f, float x, vec2 seen) {
    float core = min(f, max(x, 0.0));
    return seen.x * core + seen.y * (f - core);
}
