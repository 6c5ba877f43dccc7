// The crossings that count what they visit of a mesh, apart from the tracer's: in one file, the compiler would inline
// less of both.
#define RAYBOUND_COUNTED
#include "raybound/shapes/intersect.cpp"
