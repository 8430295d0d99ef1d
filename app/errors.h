#pragma once
// Exit codes: 0 good, 1 the work failed, 2 wrong usage or input.

#include <stdexcept>
#include <string>

namespace gnomon::app {

inline constexpr int kGood = 0, kFailed = 1, kWrongUsage = 2;

/// Wrong usage or input, as one sentence. Every other exception that reaches main() means that the work failed.
class UsageError : public std::runtime_error {
public:
    explicit UsageError(const std::string& sentence) : std::runtime_error(sentence) {}
};

}  // namespace gnomon::app
