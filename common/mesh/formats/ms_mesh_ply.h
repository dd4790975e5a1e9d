/** The header of a PLY file. Private to the reader of PLY. */
#ifndef MS_MESH_PLY_H
#define MS_MESH_PLY_H

#include "base/ms_text.h"

enum { MS_PLY_MAX_ELEMENTS = 32, MS_PLY_MAX_PROPERTIES = 512 };

typedef enum ms_ply_type {
    MS_PLY_NONE,
    MS_PLY_INT8,
    MS_PLY_UINT8,
    MS_PLY_INT16,
    MS_PLY_UINT16,
    MS_PLY_INT32,
    MS_PLY_UINT32,
    MS_PLY_FLOAT32,
    MS_PLY_FLOAT64
} ms_ply_type;

/** What a property is to a mesh. */
typedef enum ms_ply_role { MS_PLY_IGNORED, MS_PLY_X, MS_PLY_Y, MS_PLY_Z, MS_PLY_CORNERS, MS_PLY_STRIP } ms_ply_role;

typedef struct ms_ply_property {
    ms_ply_type type;
    ms_ply_type count_type; /* of a list; MS_PLY_NONE for a single value */
    ms_ply_role role;
} ms_ply_property;

typedef enum ms_ply_kind { MS_PLY_OTHER, MS_PLY_VERTEX, MS_PLY_FACE, MS_PLY_STRIPS } ms_ply_kind;

/** A table of the file: `count` rows with the properties first .. first + n_properties - 1. */
typedef struct ms_ply_element {
    ms_ply_kind kind;
    size_t count;
    size_t first;
    size_t n_properties;
    size_t line; /* where the header announces it */
} ms_ply_element;

typedef enum ms_ply_encoding { MS_PLY_ASCII, MS_PLY_LITTLE_ENDIAN, MS_PLY_BIG_ENDIAN } ms_ply_encoding;

typedef struct ms_ply_header {
    ms_ply_encoding encoding;
    size_t n_elements;
    size_t n_properties;
    ms_ply_element element[MS_PLY_MAX_ELEMENTS];
    ms_ply_property property[MS_PLY_MAX_PROPERTIES];
} ms_ply_header;

/** Bytes of a value in a binary file. */
size_t ms_mesh_ply_type_size(ms_ply_type type);

/**
 * Reads the header and checks that it describes a mesh and that what it announces fits into the rest of the file.
 *
 * @param[in,out] text at the start of the file; then at the first byte behind the header
 */
ms_status ms_mesh_ply_parse_header(ms_ply_header *header, ms_text *text, ms_error *err);

#endif
