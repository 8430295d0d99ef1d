#pragma once
// GNOMON_API marks what a shared library shows to its host; everything else in it is hidden. In a static library it is
// empty. The CMake target defines GNOMON_SHARED for hosts, and GNOMON_BUILDING while the library itself is compiled.

#if !defined(GNOMON_SHARED)
#define GNOMON_API
#elif !defined(_WIN32)
#define GNOMON_API __attribute__((visibility("default")))
#elif defined(GNOMON_BUILDING)
#define GNOMON_API __declspec(dllexport)
#else
#define GNOMON_API __declspec(dllimport)
#endif
