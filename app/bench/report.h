#pragma once
// The times of several variants, measured in turn, and what is said about them.

#include "app/bench/floor.h"
#include "app/bench/spread.h"
#include "app/frame_json.h"

namespace gnomon::app {

class Variant {
public:
    explicit Variant(std::string name) { last_.shadows = std::move(name); }
    void add(const renderer::FrameReport& report);
    [[nodiscard]] const std::string& name() const { return last_.shadows; }
    [[nodiscard]] FrameResult& last() { return last_; }
    [[nodiscard]] const FrameResult& last() const { return last_; }

    struct Row {
        std::string name;
        Phase phase = Phase::Host;
        RowKind kind = RowKind::Compute;
        std::vector<double> milliseconds;
    };
    [[nodiscard]] const std::vector<Row>& passes() const { return passes_; }
    [[nodiscard]] const Row* pass(const std::string& name) const;  ///< null where the variant has no such pass
    [[nodiscard]] const std::vector<double>& drawing() const { return drawing_; }
    [[nodiscard]] const std::vector<double>& compute() const { return compute_; }    ///< shadow phases and lighting
    [[nodiscard]] const std::vector<double>& phases() const { return phases_; }      ///< shadow phases alone
    [[nodiscard]] const std::vector<double>& lighting() const { return lighting_; }  ///< lighting passes alone
    [[nodiscard]] const std::vector<double>& prepare() const { return prepare_; }

private:
    FrameResult last_;
    std::vector<Row> passes_;
    std::vector<double> drawing_, compute_, phases_, lighting_, prepare_;
};

/// All that one run of `gnomon bench` found out.
struct Measurement {
    const Session& session;
    std::vector<Variant> variants;
    std::optional<renderer::DeviceRates> rates;  ///< where floors were asked for
    std::uint32_t warmUp = 0;                    ///< rounds that did not count
    double framesPerSecond = 0.0;                ///< of the animations' time; 0: they stood
    /// Of one more frame with LightLists::Pixel, which the paper counts by. For presets alone.
    std::optional<FrameStatistics> byPixel;
};

/// Null where that variant was not measured.
const Variant* find(const std::vector<Variant>& variants, const std::string& name);

/// Median over the rounds of compute time of `a` over that of `b`, frame against neighbouring frame.
double medianRatio(const Variant& a, const Variant& b);

/// "by froxel" or "by pixel": which lights the lists hold that were measured.
const char* listsName(const Session& session);

void printBench(const Measurement& measured);
Json describeBench(const Measurement& measured);
Json toJson(const std::vector<double>& milliseconds);

}  // namespace gnomon::app
