#pragma once
// What the instructions of a shader do with the resources that it declares.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace gnomon::house {

/// By any path, also one that a specialization constant may close.
struct ShaderAccess {
    bool read = false, written = false;
};

/// By the id of the variable, for all variables that are not local to a function and that an instruction uses. Reads of
/// an array's length count. Throws std::runtime_error where a pointer goes where this does not follow: into a call, or
/// into a choice between two pointers.
std::map<std::uint32_t, ShaderAccess> accessesOf(const std::vector<std::uint32_t>& words, const std::string& name);

}  // namespace gnomon::house
