#include "ms_view_base64.h"

#include <stdint.h>

void ms_view_base64_put(FILE *stream, const void *values, size_t count, size_t each)
{
    static const char SIGN[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint16_t one = 1;
    const size_t size = count * each, turn = *(const uint8_t *)&one ? 0 : each - 1; /* each byte's place in its value */
    const uint8_t *byte = values;
    for (size_t at = 0; at < size; at += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++) {
            bits = bits << 8 | (at + k < size ? byte[(at + k) ^ turn] : 0u);
        }
        for (size_t k = 0; k < 4; k++) {
            putc(at + k <= size ? SIGN[bits >> (18 - 6 * k) & 63] : '=', stream);
        }
    }
}
