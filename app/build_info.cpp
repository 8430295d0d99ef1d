#include "app/build_info.h"

#include <cstdlib>

namespace gnomon::app {

std::string version() {
    return GNOMON_VERSION;
}

std::string commit() {
    if (const char* given = std::getenv("GNOMON_COMMIT"); given != nullptr && *given != '\0') return given;
    const std::string built = GNOMON_COMMIT;
    return built.empty() ? "unknown" : built;
}

}  // namespace gnomon::app
