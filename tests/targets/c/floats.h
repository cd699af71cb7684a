#include <stdint.h>
#include <string.h>

/* The raw values of floats: the smallest float above 0.0 has 1, and -0.0 has -1. */
static inline int64_t rank32(const float *value)
{
    int32_t bits;
    memcpy(&bits, value, sizeof bits);
    return bits < 0 ? bits ^ INT32_MAX : bits;
}

static inline int64_t rank64(const double *value)
{
    int64_t bits;
    memcpy(&bits, value, sizeof bits);
    return bits < 0 ? bits ^ INT64_MAX : bits;
}

static inline void unrank32(float *value, int64_t rank)
{
    const int32_t bits = (int32_t)(rank < 0 ? rank ^ INT32_MAX : rank);
    memcpy(value, &bits, sizeof bits);
}

static inline void unrank64(double *value, int64_t rank)
{
    const int64_t bits = rank < 0 ? rank ^ INT64_MAX : rank;
    memcpy(value, &bits, sizeof bits);
}
