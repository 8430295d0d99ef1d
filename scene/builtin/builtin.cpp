#include "scene/builtin/builtin.h"

#include "scene/builtin/scenes.h"

#include <array>

namespace gnomon::renderer {
namespace {

struct Entry {
    const char* name;
    const char* description;
    Scene (*make)(const BuiltinOptions&);
};

constexpr std::array kEntries = {
    Entry{"courtyard", "A courtyard at night: arcades, lanterns, cloth, leaves, people who move; a moon.",
          [](const BuiltinOptions&) { return makeCourtyardNight(); }},
    Entry{"courtyard-day", "The courtyard under a low sun, with the lanterns in its shade lit.",
          [](const BuiltinOptions&) { return makeCourtyardDay(); }},
    Entry{"courtyard-bench", "The courtyard at night, lit so that about 3 shadowed lights reach a tile at 3840x2160.",
          [](const BuiltinOptions&) { return makeCourtyardBench(); }},
    Entry{"bias-lab",
          "What shadowmaps get wrong, far from the origin: sand, grazing planes, thin plates, lace, contacts, ears.",
          [](const BuiltinOptions&) { return makeBiasLab(); }},
    Entry{"empty-plane", "A plane and one spot.", [](const BuiltinOptions&) { return makeEmptyPlane(); }},
    Entry{"sphere-on-plane", "A sphere of 1 m over a plane, one point light: penumbrae with closed forms.",
          [](const BuiltinOptions&) { return makeSphereOnPlane(); }},
    Entry{"boxes", "A closed room with two boxes and three point lights.",
          [](const BuiltinOptions&) { return makeBoxes(); }},
    Entry{"columns", "Rows of thin columns; lightCount (12) lights at places from the seed.",
          [](const BuiltinOptions& options) { return makeColumns(options); }},
    Entry{"cloth", "Double-sided sheets without thickness between two lights.",
          [](const BuiltinOptions&) { return makeCloth(); }},
    Entry{"masked", "Panels with alpha-tested holes, a point and a spot behind them.",
          [](const BuiltinOptions&) { return makeMasked(); }},
    Entry{"sundial", "A dial and obelisks from 4 m to 150 m under the sun, and one lamp: every cascade.",
          [](const BuiltinOptions&) { return makeSundial(); }},
    Entry{"single-triangle", "One double-sided triangle and one point light.",
          [](const BuiltinOptions&) { return makeSingleTriangle(); }},
    Entry{"lights-only", "Three lights and nothing to shine on.",
          [](const BuiltinOptions&) { return makeLightsOnly(); }},
};

}  // namespace

std::vector<BuiltinInfo> builtinScenes() {
    std::vector<BuiltinInfo> infos;
    for (const Entry& entry : kEntries) infos.push_back({entry.name, entry.description});
    return infos;
}

std::optional<Scene> makeBuiltinScene(std::string_view name, const BuiltinOptions& options) {
    for (const Entry& entry : kEntries)
        if (name == entry.name) return entry.make(options);
    return std::nullopt;
}

}  // namespace gnomon::renderer
