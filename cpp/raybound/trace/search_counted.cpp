// The searches that count what they visit, apart from the tracer's: in one file, the compiler would inline less of
// both.
#define RAYBOUND_COUNTED
#include "raybound/trace/search.cpp"
