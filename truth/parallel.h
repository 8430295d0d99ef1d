#pragma once
// Work for all cores, in pieces that do not depend on their number.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace gnomon::renderer {

/// Calls work(i) once for each i below `count`, from several threads at once.
template <class Work>
void forEachInParallel(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next = 0;
    const auto take = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    const std::size_t threads = std::min<std::size_t>(std::max(std::thread::hardware_concurrency(), 1u), count);
    std::vector<std::jthread> pool;
    for (std::size_t i = 1; i < threads; ++i) pool.emplace_back(take);
    take();
}

}  // namespace gnomon::renderer
