#pragma once
// The times of several variants, measured in turn, and what is said about them.

#include "app/frame_json.h"

namespace gnomon::app {

struct Spread {
    double median = 0.0, min = 0.0, p95 = 0.0;
};
/// Nearest-rank percentiles; zeros without values.
Spread spreadOf(std::vector<double> values);

class Variant {
public:
    explicit Variant(std::string name) { last_.shadows = std::move(name); }
    void add(const renderer::FrameReport& report);
    [[nodiscard]] const std::string& name() const { return last_.shadows; }
    [[nodiscard]] FrameResult& last() { return last_; }
    [[nodiscard]] const FrameResult& last() const { return last_; }

    struct Row {
        std::string name;
        bool drawing = false, statistics = false;
        std::vector<double> milliseconds;
    };
    [[nodiscard]] const std::vector<Row>& passes() const { return passes_; }
    [[nodiscard]] const std::vector<double>& drawing() const { return drawing_; }
    [[nodiscard]] const std::vector<double>& compute() const { return compute_; }  ///< shadow phases and lighting
    [[nodiscard]] const std::vector<double>& prepare() const { return prepare_; }

private:
    FrameResult last_;
    std::vector<Row> passes_;
    std::vector<double> drawing_, compute_, prepare_;
};

/// Median over the rounds of compute time of `a` over that of `b`, frame against neighbouring frame.
double medianRatio(const Variant& a, const Variant& b);

void printBench(const Session& session, const std::vector<Variant>& variants);
Json describeBench(const Session& session, const std::vector<Variant>& variants);

}  // namespace gnomon::app
