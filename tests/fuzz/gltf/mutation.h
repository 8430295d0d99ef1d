#pragma once
// glTF files that are wrong in ways that bytes at random hardly ever are: JSON stays JSON, but numbers, types, words
// and references change, parts are left out, doubled, or put where others belong.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>

namespace gnomon::fuzz {

using Random = std::mt19937_64;

/// One to four changes of any part. The same file and the same state of `random` give the same result.
[[nodiscard]] nlohmann::json mutated(nlohmann::json file, Random& random);

}  // namespace gnomon::fuzz
