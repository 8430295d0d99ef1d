#pragma once
// GNOMON_API marks what a shared library shows to its host; everything else in it is hidden, and GNOMON_HIDDEN says so
// of what stands inside a shown class. In a static library neither matters. The CMake target defines GNOMON_SHARED for
// hosts, and GNOMON_BUILDING while the library itself is compiled.

#if defined(_WIN32)
#define GNOMON_HIDDEN
#else
#define GNOMON_HIDDEN __attribute__((visibility("hidden")))
#endif

#if !defined(GNOMON_SHARED)
#define GNOMON_API
#elif !defined(_WIN32)
#define GNOMON_API __attribute__((visibility("default")))
#elif defined(GNOMON_BUILDING)
#define GNOMON_API __declspec(dllexport)
#else
#define GNOMON_API __declspec(dllimport)
#endif
