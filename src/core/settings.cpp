#include "core/settings.h"

#include <cmath>

#include "gpu_interface/numbers.h"

namespace gnomon {
namespace {

using namespace gpu;

static_assert(static_cast<std::uint32_t>(Filter::Hard) == kFilterHard);
static_assert(static_cast<std::uint32_t>(Filter::Pcf) == kFilterPcf);
static_assert(static_cast<std::uint32_t>(Filter::Pcss) == kFilterPcss);
static_assert(static_cast<std::uint32_t>(Filter::Host) == kFilterHost);
static_assert(static_cast<std::uint32_t>(Filter::PcssShared) == kFilterPcssShared);
static_assert(static_cast<std::uint32_t>(LightLists::Froxel) == kListsByFroxel);
static_assert(static_cast<std::uint32_t>(LightLists::Pixel) == kListsByPixel);
static_assert(gnomon::kMaxPcssPresets == gpu::kMaxPcssPresets);
static_assert(static_cast<std::uint32_t>(DepthBias::Oriented) == kDepthBiasOriented);
static_assert(static_cast<std::uint32_t>(DepthBias::OrientedConstant) == kDepthBiasOrientedConstant);
static_assert(static_cast<std::uint32_t>(DepthBias::Unbiased) == kDepthBiasUnbiased);
static_assert(static_cast<std::uint32_t>(ListReservation::Approximate) == kReserveApproximate);
static_assert(static_cast<std::uint32_t>(ListReservation::Accurate) == kReserveAccurate);
static_assert(static_cast<std::uint32_t>(ListReservation::Fixed) == kReserveFixed);

constexpr FilterSet kAllFilters = kAllBuiltInFilters | only(Filter::Host);

Result checkTaps(const ShadowSettings& s) {
    if (s.pcssPresetCount < 1 || s.pcssPresetCount > gpu::kMaxPcssPresets) {
        return Result::failure(Status::BadArgument, "ShadowSettings::pcssPresetCount is %u; it must be 1 to %u.",
                               s.pcssPresetCount, gpu::kMaxPcssPresets);
    }
    for (std::uint32_t i = 0; i < s.pcssPresetCount; ++i) {
        const PcssTaps& taps = s.pcssPresets[i];
        const bool good = taps.searchTaps >= 1 && taps.searchTaps <= kMaxPcssTaps && taps.filterTaps >= 1 &&
                          taps.filterTaps <= kMaxPcssTaps;
        if (good) continue;
        return Result::failure(Status::BadArgument,
                               "ShadowSettings::pcssPresets[%u] has %u and %u taps; each must be 1 to %u.", i,
                               taps.searchTaps, taps.filterTaps, kMaxPcssTaps);
    }
    return {};
}

}  // namespace

Result checkSettings(const ShadowSettings& s) noexcept {
    if ((s.filters & ~kAllFilters) != 0) {
        return Result::failure(Status::BadArgument, "ShadowSettings::filters is 0x%x; it has bits that are no filter.",
                               s.filters);
    }
    if (s.pcfRadius < 1 || s.pcfRadius > kMaxPcfRadius) {
        return Result::failure(Status::BadArgument, "ShadowSettings::pcfRadius is %u; it must be 1 to %u texels.",
                               s.pcfRadius, kMaxPcfRadius);
    }
    if (Result checked = checkTaps(s); !checked) return checked;
    if (static_cast<std::uint32_t>(s.depthBias) > kDepthBiasUnbiased) {
        return Result::failure(Status::BadArgument, "ShadowSettings::depthBias is none of DepthBias.");
    }
    if (!(s.subsurfaceBiasMetres >= 0.0f) || s.subsurfaceBiasMetres > 1e6f) {
        return Result::failure(Status::BadArgument,
                               "ShadowSettings::subsurfaceBiasMetres must be a length of at least 0.");
    }
    if (s.visibilityBits != kMaxVisibilityBits && s.visibilityBits != kMinVisibilityBits) {
        return Result::failure(Status::BadArgument, "ShadowSettings::visibilityBits is %u; it must be 8 or 4.",
                               s.visibilityBits);
    }
    if (static_cast<std::uint32_t>(s.lightLists) > kListsByPixel) {
        return Result::failure(Status::BadArgument, "ShadowSettings::lightLists is none of LightLists.");
    }
    if (static_cast<std::uint32_t>(s.listReservation) > kReserveFixed) {
        return Result::failure(Status::BadArgument, "ShadowSettings::listReservation is none of ListReservation.");
    }
    if (s.listReservation == ListReservation::Fixed &&
        (s.fixedListEntriesPerTile < 1 || s.fixedListEntriesPerTile > kMaxLightsPerView)) {
        return Result::failure(Status::BadArgument,
                               "ShadowSettings::fixedListEntriesPerTile is %u; it must be 1 to %u.",
                               s.fixedListEntriesPerTile, kMaxLightsPerView);
    }
    return {};
}

Specialization specializationOf(const ShadowSettings& s) noexcept {
    Specialization out = {};
    out.filters = s.filters;
    out.listReservation = static_cast<std::uint32_t>(s.listReservation);
    out.lightLists = static_cast<std::uint32_t>(s.lightLists);
    out.pcfRadius = s.pcfRadius;
    out.hostDepthPyramid = s.hostDepthPyramid ? 1u : 0u;
    out.pcssPresets = s.pcssPresetCount;
    out.visibilityBits = s.visibilityBits;
    out.depthBias = static_cast<std::uint32_t>(s.depthBias);
    out.facedAwayIsDark = s.facedAwayIsDark ? 1u : 0u;
    return out;
}

void writePcssTaps(const ShadowSettings& s, GpuFrame& frame) noexcept {
    for (std::uint32_t i = 0; i < gpu::kMaxPcssPresets; ++i) {
        const PcssTaps& taps = s.pcssPresets[i < s.pcssPresetCount ? i : 0];
        const auto search = static_cast<float>(taps.searchTaps), filter = static_cast<float>(taps.filterTaps);
        frame.pcssTaps[i] = {taps.searchTaps, taps.filterTaps, 1.0f / (search * search), 1.0f / filter};
    }
    // Source: Vogel 1979, "A better way to construct the sunflower head".
    constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt 5)
    for (std::uint32_t i = 0; i < gpu::kMaxPcssTaps; ++i) {
        const double angle = kGoldenAngle * i, place = i + 0.5;
        const double x = std::cos(angle), y = std::sin(angle), filtered = std::sqrt(place), searched = place * place;
        frame.pcssPattern[i] = {{static_cast<float>(filtered * x), static_cast<float>(filtered * y)},
                                {static_cast<float>(searched * x), static_cast<float>(searched * y)},
                                static_cast<float>(searched),
                                0.0f,
                                0.0f,
                                0.0f};
    }
}

}  // namespace gnomon
