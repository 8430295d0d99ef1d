#pragma once
// The whole public face of the library.
#include "gnomon/context.h"
#include "gnomon/prepare.h"
#include "gnomon/result.h"
#include "gnomon/scene.h"
#include "gnomon/settings.h"
#include "gnomon/timeline.h"
#include "gnomon/view.h"
