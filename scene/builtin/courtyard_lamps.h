#pragma once
// Lanterns and lamps without their lights. Every mesh has the light's place as its origin, and leaves some centimetres
// of air around it. The glowing part is a bulb or flame next to the light: one that enclosed the light would shadow
// everything.

#include "scene/builtin/courtyard.h"

namespace gnomon::renderer::courtyard {

std::uint32_t hangingLantern(Parts& parts, float chainLength);
/// On a post whose foot is `height` below the light.
std::uint32_t standingLantern(Parts& parts, float height, float postRadius);
/// A shade of paper, open below and above, on a cord.
std::uint32_t paperLantern(Parts& parts, std::uint32_t paper, float cordLength);
/// A drum of pierced brass, and the chain that it turns on.
std::uint32_t piercedDrum(Parts& parts);
std::uint32_t drumChain(Parts& parts, float length);
/// Stands 15 cm below the light.
std::uint32_t thickCandle(Parts& parts);
/// Sits on a wall behind the light, at z = -0.3.
std::uint32_t wallLamp(Parts& parts);
/// Throws its light along -z.
std::uint32_t eavesLamp(Parts& parts);

}  // namespace gnomon::renderer::courtyard
