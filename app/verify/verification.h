#pragma once
// The work of `gnomon verify`: draws a frame, traces the truth of its lights, and judges what each of them drew.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/progress.h"
#include "app/session.h"
#include "app/verify/maps.h"
#include "app/verify/options.h"
#include "app/verify/report.h"
#include "scene/pose.h"

namespace gnomon::app {

class Verification {
public:
    /// Draws and prepares. Session and options must outlive this. `others`: what else to judge by the same truth.
    Verification(const Session& session, const VerifyOptions& options, std::vector<BiasSetting> others);

    VerifyResult run();

private:
    struct TracedLight {
        std::uint32_t index = 0;
        renderer::LightTruthDesc desc;
        renderer::LightTruth truth;
    };

    [[nodiscard]] std::vector<std::uint32_t> wantedLights() const;
    /// Returns the frame's number.
    std::uint64_t drawFrom(const renderer::SceneCamera& camera);
    void drawSetting(std::size_t setting);
    void checkShadowViews() const;
    [[nodiscard]] renderer::LightTruthDesc truthDescOf(std::uint32_t index) const;
    /// From lights_[next] on, as many as memory has room for; moves `next` behind them.
    std::vector<TracedLight> traceSome(std::size_t& next);
    void judgeChosen(std::vector<TracedLight>& lights, VerifyResult& result);
    void judgeOthers(std::vector<TracedLight>& lights, VerifyResult& result);
    [[nodiscard]] renderer::LightFigures judge(TracedLight& light, const std::vector<float>& visibility) const;
    void measureFlicker(VerifyResult& result);
    void say(const std::string& sentence, bool last);
    [[nodiscard]] bool soft() const { return allSoft(session_.rendererDesc().frame.filters); }

    const Session& session_;
    const VerifyOptions& options_;
    std::vector<BiasSetting> others_;
    renderer::Pose pose_;
    renderer::SceneCamera camera_;  // posed
    renderer::TracedScene traced_;
    renderer::TruthExtent extent_;
    renderer::Renderer renderer_;
    std::size_t drawn_ = 0;  // 0: the chosen setting; else others_[drawn_ - 1]
    std::vector<renderer::TruthReceiver> receivers_;
    std::vector<TracedLight> lights_;   // without truth
    std::unique_ptr<VerifyMaps> maps_;  // where asked for
    Stopwatch watch_;
    double said_ = -1.0;
    std::uint32_t lightsLeftOut_ = 0;  // visible ones, of the chosen camera
};

}  // namespace gnomon::app
