#pragma once
// Leaf cards: pictures of twigs with an alpha channel, painted by code.
//
// Filtering. Texels outside the leaves carry the mean leaf colour, so that smaller mips have no dark rims. A card's
// cut-off is its mean alpha: then a mip of few texels neither closes to a plate nor vanishes.

#include "scene/scene.h"

namespace gnomon::renderer {

float meanAlpha(const Image& image);

// Each is size by size texels, the twig growing upwards from the middle of the lower edge.
Image paintBroadLeaves(std::uint32_t size);                         // a twig of an orange tree
Image paintIvy(std::uint32_t size);                                 // lobed leaves
Image paintBlossom(std::uint32_t size);                             // bougainvillea: bracts and some leaves
Image paintFrond(std::uint32_t size);                               // one palm or fern frond
Image paintStarCutouts(std::uint32_t size, const glm::vec3& tint);  // sheet metal with stars cut out; repeats
Image paintPaperGlow(std::uint32_t size);  // a paper lantern's hoops, lit from within; 4 texels wide

}  // namespace gnomon::renderer
