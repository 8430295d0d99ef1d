#pragma once
// What a checker of the oracle found: the number of errors, and the first few in words. And the three verdicts on a
// decision that hangs on floating point (design: "measures", Oracles and floating point).

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace gnomon::reference {

/// On whether something is so, in double precision and with a stated margin for the 32-bit floats of who decides it.
enum class Verdict {
    Never,  ///< not so, by more than the margin
    May,    ///< too close to call
    Must,   ///< so, by more than the margin
};

/// Both hold.
inline Verdict both(Verdict a, Verdict b) {
    return a < b ? a : b;
}
/// At least one holds.
inline Verdict either(Verdict a, Verdict b) {
    return a < b ? b : a;
}
/// Is `value` at least zero, where it is known to within `margin` (0 or more)?
inline Verdict atLeastZero(double value, double margin) {
    if (value >= margin) return Verdict::Must;
    return value < -margin ? Verdict::Never : Verdict::May;
}

struct Findings {
    static constexpr std::size_t kMaxMessages = 20;

    std::size_t errors = 0;
    std::vector<std::string> messages;  ///< of the first kMaxMessages errors

    [[nodiscard]] bool ok() const { return errors == 0; }

    /// Counts one error, told as a printf format.
    void add(const char* format, ...) {
        ++errors;
        if (messages.size() >= kMaxMessages) return;
        char text[512];
        std::va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(text, sizeof(text), format, arguments);
        va_end(arguments);
        messages.emplace_back(text);
    }

    void append(const Findings& other) {
        errors += other.errors;
        for (const std::string& message : other.messages)
            if (messages.size() < kMaxMessages) messages.push_back(message);
    }

    /// All messages, one per line, for a test's failure text.
    [[nodiscard]] std::string text() const {
        std::string result = std::to_string(errors) + " errors\n";
        for (const std::string& message : messages) result += "  " + message + "\n";
        return result;
    }
};

}  // namespace gnomon::reference
