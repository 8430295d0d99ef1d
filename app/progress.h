#pragma once
// What the program says on stderr while it works.

#include <chrono>
#include <string>

namespace gnomon::app {

void silenceProgress();
void sayProgress(const std::string& sentence);
void sayWarning(const std::string& sentence);

class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Says "Frame n of N" for the first and the last frame and otherwise once a second at most.
class FrameProgress {
public:
    explicit FrameProgress(std::uint64_t total) : total_(total) {}
    void step();

private:
    std::uint64_t total_, done_ = 0;
    double said_ = -1.0;
    Stopwatch watch_;
};

}  // namespace gnomon::app
