/** Bytes as text. */
#ifndef MS_VIEW_BASE64_H
#define MS_VIEW_BASE64_H

#include <stddef.h>
#include <stdio.h>

/** RFC 4648, section 4, without line ends. @param each bytes of a value: 1, 2 or 4, which go out little-endian */
void ms_view_base64_put(FILE *stream, const void *values, size_t count, size_t each);

#endif
