#pragma once
// Everything of a frame's shadows that a user tunes, as one value. It is chosen anew for every frame: changing it makes
// neither a context nor a view anew. Pipelines for settings that were not met before are made when they are first
// needed, or ahead of time by Context::prepare().

#include <array>
#include <cstdint>

#include "gnomon/export.h"
#include "gnomon/result.h"

namespace gnomon {

/// How a light's shadowmaps are read. Each light has its own: Light::filter.
enum class Filter : std::uint8_t {
    Hard,  ///< one texel, one comparison
    Pcf,   ///< percentage closer filtering over (2 * pcfRadius + 1)^2 bilinear comparisons
    Pcss,  ///< percentage closer soft shadows: a penumbra as wide as the light's source makes it
    Host,  ///< a function of the host's own; needs ContextDesc::filterPairsSpirv
    /// Like Pcss, but 2x2 pixels share one search for blockers, and narrow penumbrae take fewer taps. Faster. Forward
    /// surfaces have no such neighbours: give them Filter::Pcss.
    PcssShared,
};

/// Whether a filter makes a penumbra as wide as the light's source: those that PcssTaps are for.
constexpr bool isSoft(Filter filter) noexcept {
    return filter == Filter::Pcss || filter == Filter::PcssShared;
}

/// A set of filters, one bit each.
using FilterSet = std::uint32_t;
constexpr FilterSet only(Filter filter) noexcept {
    return 1u << static_cast<std::uint32_t>(filter);
}
inline constexpr FilterSet kAllBuiltInFilters =
    only(Filter::Hard) | only(Filter::Pcf) | only(Filter::Pcss) | only(Filter::PcssShared);

/// Taps of Filter::Pcss and Filter::PcssShared, each a gather of four texels. A pixel outside of penumbrae takes
/// searchTaps at most, one inside also filterTaps. With PcssShared 2x2 pixels take searchTaps once.
struct PcssTaps {
    std::uint32_t searchTaps = 16;  ///< 1 to 64
    std::uint32_t filterTaps = 24;  ///< 1 to 64
    bool operator==(const PcssTaps&) const = default;
};
inline constexpr PcssTaps kPcssLow = {8, 12};
inline constexpr PcssTaps kPcssMedium = {16, 24};
inline constexpr PcssTaps kPcssHigh = {32, 64};
inline constexpr std::uint32_t kMaxPcssPresets = 4;

/// What keeps a receiver from shadowing itself.
enum class DepthBias : std::uint8_t {
    /// Nearer to the light by Light::biasMetres, in linear depth, and each texel compared with the plane of the
    /// receiver's face at its own centre. Draw shadowmaps without hardware bias. Needs no tuning.
    /// Source: the paper, section 4.2; the plane is ours.
    Oriented,
    /// The paper's listing 7 as it is meant: one depth for all texels, nearer to the light where the face looks at it,
    /// farther where it looks away. Draw shadowmaps with a slope factor of 1, and set facedAwayIsDark to false.
    OrientedConstant,
    /// Depths are compared as they are: for hosts that draw their shadowmaps with a hardware bias.
    Unbiased,
};

/// Which lights a tile's list holds before phase 4.
enum class LightLists : std::uint8_t {
    Froxel,  ///< those that may reach the tile's froxel. Phase 2 writes them, and phase 3 does nothing.
    Pixel,   ///< those that reach a pixel of the tile: the paper's phase 3. Fewer lights, but slower in all.
};

/// How space in the light lists is given out.
enum class ListReservation : std::uint8_t {
    Approximate,  ///< the paper's way: by phase 2, one atomic per 64 tiles, as much as the approximate count
    /// By the phase that writes the lists, as much as the exact count. With LightLists::Froxel it is the same as
    /// Approximate; with LightLists::Pixel it takes one atomic per tile.
    Accurate,
    Fixed,  ///< debugging: fixedListEntriesPerTile for every tile, at predictable addresses
};

/// Plain values with working defaults; equal values have equal pipelines.
struct ShadowSettings {
    /// Filters that the frame's lights may have. Pipelines hold the code of these alone, and are fastest with a single
    /// one. Empty: no shadow is evaluated and everything is lit. So it shows what the lists cost by themselves.
    FilterSet filters = only(Filter::Pcss);
    std::uint32_t pcfRadius = 1;  ///< texels, 1 to 3
    /// Light::pcssPreset chooses among the first pcssPresetCount of them.
    std::array<PcssTaps, kMaxPcssPresets> pcssPresets = {kPcssMedium, kPcssLow, kPcssHigh, kPcssMedium};
    std::uint32_t pcssPresetCount = 1;  ///< 1 to kMaxPcssPresets; one is fastest
    /// Turns the sample pattern of the soft filters from frame to frame, for hosts that accumulate frames.
    bool patternPerFrame = false;
    /// View::recordShadowBounds() will be called in this frame. Bounds are kept from frame to frame while
    /// ShadowView::changed is false; set that true once after a recorded frame that was never submitted.
    bool shadowBounds = false;
    DepthBias depthBias = DepthBias::Oriented;
    /// A pixel whose face looks away from a light is dark, and the light's shadowmaps are not asked. This does not hold
    /// for subsurface pixels. Where it is off, with DepthBias::Unbiased, face normals are not read at all.
    bool facedAwayIsDark = true;
    /// Phase 3, where it runs, drops lights that every pixel of a tile looks away from, with facedAwayIsDark.
    bool dropLightsFacedAway = true;
    /// Subsurface pixels move toward the light by this many metres, if it is more than the light's own bias. 0 is right
    /// where subsurface casters are drawn without the faces that look at the light. Where these faces are drawn too, it
    /// is the thickness through which light shall pass. Source: the paper, section 4.2.
    float subsurfaceBiasMetres = 0.02f;
    /// Bits of a pixel's visibility in a slot: 8, or 4 for half the memory and an error of up to 0.066.
    std::uint32_t visibilityBits = 8;
    LightLists lightLists = LightLists::Froxel;
    ListReservation listReservation = ListReservation::Accurate;
    std::uint32_t fixedListEntriesPerTile =
        0;  ///< for ListReservation::Fixed, 1 to 1024; rounded up to a multiple of 3
    /// The host gives FrameDesc::depthPyramid, a two-channel pyramid level, instead of having one built.
    bool hostDepthPyramid = false;

    bool operator==(const ShadowSettings&) const = default;
};

/// Fails with a sentence on the first value outside its range. Thread safe.
GNOMON_API Result checkSettings(const ShadowSettings& settings) noexcept;

}  // namespace gnomon
