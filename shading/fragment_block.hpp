// The unit of shading: up to kBlockSize fragments of one material as structure of arrays. raster fills the attribute
// rows, the shading stages fill the colour rows. A value depends on its own lane only, never on its neighbours, the lane
// number or the block's fill, so any packing of pixels into blocks gives the same picture.
#pragma once

#include <cstdint>

namespace halflit::shading {

inline constexpr int kBlockSize = 64;  ///< lanes; a multiple of every SIMD width

// clang-format off
/// Rows of FragmentBlock::lane. The first kVertexFloats rows are interpolated from vertices, in attribute slots of four,
/// so that a vertex record is a list of 16-byte groups and a group becomes four rows by a 4x4 transpose.
enum Row : int {
    kPosX, kPosY, kPosZ, kNormalX,         // slot 0: world-space position; world-space normal, any length
    kNormalY, kNormalZ, kU0, kV0,          // slot 1: texture coordinates, set 0
    kTangentX, kTangentY, kTangentZ, kTangentW,  // slot 2: world-space tangent, any length; W: handedness, +1 or -1
    kColorR, kColorG, kColorB, kColorA,    // slot 3: vertex colour, linear
    kU1, kV1, kUnused0, kUnused1,          // slot 4: texture coordinates, set 1
    kVertexFloats,
    kDu0Dx = kVertexFloats, kDv0Dx, kDu0Dy, kDv0Dy,  // change per pixel to the right and down, set 0
    kDu1Dx, kDv1Dx, kDu1Dy, kDv1Dy,                  // set 1
    kFacing,                               // +1 front face, -1 back face
    kShadowX, kShadowY, kShadowZ,          // offset from the position to the point where shadows are looked up, world space
    kInputRows
};
// clang-format on
inline constexpr int kSlotCount = 5;

/// A set of attribute slots; bit s for slot s.
using SlotMask = std::uint32_t;
inline constexpr SlotMask kPositionSlot = 1u, kUv0Slot = 2u, kTangentSlot = 4u, kColorSlot = 8u, kUv1Slot = 16u;
inline constexpr SlotMask kBaseSlots =
    kPositionSlot | kUv0Slot;  ///< position, normal and the first texture coordinates, which every mesh has

struct alignas(64) FragmentBlock {
    float lane[kInputRows][kBlockSize];
    /// Result: linear light, not premultiplied; alpha is 1 for opaque and mask materials.
    alignas(64) float red[kBlockSize], green[kBlockSize], blue[kBlockSize], alpha[kBlockSize];
    /// Result for materials that transmit: shares of the light from behind that pass, in red, green and blue, in [0, 1]. Elsewhere it is
    /// 1 - alpha, and these are not set.
    alignas(64) float keep[3][kBlockSize];
};

}  // namespace halflit::shading
