#pragma once
// The whole public face of the library.
#include "gnomon/prepare.h"
#include "gnomon/result.h"
#include "gnomon/scene.h"
#include "gnomon/tiled_shadows.h"
