#pragma once
// How every call of the library reports success or failure. No exception crosses the library's boundary.

#include <cstdarg>
#include <cstdio>

namespace gnomon {

enum class Status {
    Ok,
    BadArgument,        ///< The caller broke a stated rule; the message says which and what to do.
    UnsupportedDevice,  ///< The device lacks something that the library needs.
    OutOfMemory,        ///< An allocation on the host or the device failed.
    VulkanError,        ///< Any other failing Vulkan call.
};

/// Success, or a status with one sentence that says what to do. A value type without heap memory; thread safe to copy.
class [[nodiscard]] Result {
public:
    Result() noexcept = default;

    /// Makes a failure from a printf format. The sentence is cut at 255 characters.
    static Result failure(Status status, const char* format, ...) noexcept {
        Result result;
        result.status_ = status;
        std::va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(result.message_, sizeof(result.message_), format, arguments);
        va_end(arguments);
        return result;
    }

    [[nodiscard]] bool ok() const noexcept { return status_ == Status::Ok; }
    explicit operator bool() const noexcept { return ok(); }
    [[nodiscard]] Status status() const noexcept { return status_; }
    /// One sentence without a final newline; empty on success.
    [[nodiscard]] const char* message() const noexcept { return message_; }

private:
    Status status_ = Status::Ok;
    char message_[256] = {};
};

}  // namespace gnomon
