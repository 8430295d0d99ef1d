#pragma once
// A pass as it declares itself, in its own room beside its shader. Barriers, bindings, label, timeline row and pipeline
// follow from the declaration. A test compares it with the compiled shader, both ways.

#include <cstdint>
#include <span>

#include "gnomon/timeline.h"

namespace gnomon {

enum class Access : std::uint8_t {
    Uniform,   // read; written by the host alone
    Streamed,  // storage buffer, read; written by the host alone, so submission makes it visible
    Sampled,   // image or sampler of the host
    Read,      // storage buffer
    Write,     // storage buffer, written, or read and written
    Indirect,  // the dispatch itself reads it as its command: a pass that has one is dispatched indirectly
};

struct PassResource {
    std::uint32_t set;
    std::uint32_t binding;
    Access access;
};

struct Pass {
    const char* name;  // the shader's file name, the label in a capture, the row in every table
    Phase phase;
    std::span<const std::uint32_t> spirv;
    std::span<const PassResource> resources;
    std::span<const std::uint32_t> specialization;  // ids of the constants that the shader has
};

}  // namespace gnomon
