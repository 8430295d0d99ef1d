#pragma once
// Which light gets which squares of the shadow atlas, from what the library says of the visible lights: pure CPU.
//
// Every light wishes for as many texels as it covers pixels. If the wishes exceed the atlas, those that are largest for
// the share of the screen that their light covers are halved, until all fit. An engine will do more: keep its squares
// where they are when others come and go, and spread the drawing of many lights over several frames.

#include <gnomon/prepare.h>
#include <gnomon/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace host {

/// What FrameDesc wants of a frame's shadow views. Those with `changed` have to be drawn.
struct ShadowPlan {
    std::vector<gnomon::ShadowView> views;             ///< FrameDesc::shadowViews
    std::vector<gnomon::LightShadowViews> lightViews;  ///< FrameDesc::lightViews: one per visible light
};

class ShadowPlanner {
public:
    /// `atlasPx`: side of the square atlas, a power of two.
    explicit ShadowPlanner(std::uint32_t atlasPx) : atlasPx_(atlasPx) {}
    /// `lights`: those that View::prepare() was given. Valid until the next call.
    const ShadowPlan& plan(const gnomon::PreparedLights& prepared, std::span<const gnomon::Light> lights);

private:
    struct Wish {
        const gnomon::LightOnScreen* light = nullptr;
        std::uint32_t firstView = 0, views = 0;
        std::uint32_t sidePx = 0;  // of each view's square, a power of two
        [[nodiscard]] std::uint64_t texels() const { return std::uint64_t{views} * sidePx * sidePx; }
    };
    [[nodiscard]] bool shrinkToFit(std::vector<Wish>& wishes) const;
    void number(std::vector<Wish>& wishes, const gnomon::PreparedLights& prepared);
    void place(std::vector<Wish> wishes, std::span<const gnomon::Light> lights);

    std::uint32_t atlasPx_;
    ShadowPlan plan_;
    std::vector<gnomon::ShadowView> before_;  // the views of the frame before
};

}  // namespace host
