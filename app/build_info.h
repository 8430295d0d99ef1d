#pragma once

#include <string>

namespace gnomon::app {

/// For example "0.1.0".
std::string version();
/// The commit at configure time, or GNOMON_COMMIT of the environment; "unknown" without either.
std::string commit();

}  // namespace gnomon::app
