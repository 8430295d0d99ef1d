#include "app/progress.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace gnomon::app {
namespace {

spdlog::logger& logger() {
    static const std::shared_ptr<spdlog::logger> instance = [] {
        auto made = spdlog::stderr_color_mt("progress");
        made->set_pattern("%v");
        return made;
    }();
    return *instance;
}

}  // namespace

void silenceProgress() {
    logger().set_level(spdlog::level::warn);
}
void sayProgress(const std::string& sentence) {
    logger().info("{}", sentence);
}
void sayWarning(const std::string& sentence) {
    logger().warn("Warning: {}", sentence);
}

void FrameProgress::step() {
    ++done_;
    const double now = watch_.seconds();
    if (done_ != 1 && done_ != total_ && now - said_ < 1.0) return;
    said_ = now;
    sayProgress(fmt::format("Frame {} of {}, {:.1f} s.", done_, total_, now));
}

}  // namespace gnomon::app
