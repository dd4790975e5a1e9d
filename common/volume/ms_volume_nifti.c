/* NIfTI-1 in one file, .nii: the header is read by the nifti library, the voxels lie behind it. */
#include <math.h>
#include <string.h>

#include "ms_volume_formats.h"

#if MS_WITH_NIFTI

#include <nifti1_io.h>

static ms_status find_sample(ms_sample *sample, int datatype, const char *path, ms_error *err)
{
    static const struct {
        int code;
        ms_sample sample;
    } types[] = {
        {DT_UINT8, {MS_SAMPLE_UNSIGNED, 1}},  {DT_INT8, {MS_SAMPLE_SIGNED, 1}},
        {DT_UINT16, {MS_SAMPLE_UNSIGNED, 2}}, {DT_INT16, {MS_SAMPLE_SIGNED, 2}},
        {DT_UINT32, {MS_SAMPLE_UNSIGNED, 4}}, {DT_INT32, {MS_SAMPLE_SIGNED, 4}},
        {DT_UINT64, {MS_SAMPLE_UNSIGNED, 8}}, {DT_INT64, {MS_SAMPLE_SIGNED, 8}},
        {DT_FLOAT32, {MS_SAMPLE_FLOAT, 4}},   {DT_FLOAT64, {MS_SAMPLE_FLOAT, 8}},
    };
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        if (types[i].code == datatype) {
            *sample = types[i].sample;
            return MS_OK;
        }
    }
    return ms_fail(err, MS_ERR_FORMAT, "%s: its datatype %d is not read; save it as uint8, uint16 or float32", path,
                   datatype);
}

/* The header in the order of bytes of this machine. What the library would print about is refused here. */
static ms_status load_header(nifti_1_header *raw, int *is_swapped, const ms_bytes *bytes, const char *path,
                             ms_error *err)
{
    if (bytes->size < sizeof *raw + 4) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte %zu: ends within the header; fetch or save it again", path,
                       bytes->size);
    }
    memcpy(raw, bytes->data, sizeof *raw);
    *is_swapped = raw->sizeof_hdr != (int)sizeof *raw;
    if (*is_swapped) {
        swap_nifti_header(raw, 1);
    }
    if (memcmp(bytes->data + 4, "n+2", 4) == 0 || memcmp(bytes->data + 4, "ni2", 4) == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: NIfTI-2 is not read; save it as NIfTI-1", path);
    }
    if (memcmp(raw->magic, "ni1", 4) == 0) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte 344: its voxels are in a file apart; save both in one, .nii",
                       path);
    }
    if (memcmp(raw->magic, "n+1", 4) != 0 || raw->sizeof_hdr != (int)sizeof *raw) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: does not begin as NIfTI-1 files do; save it again", path);
    }
    int axes = raw->dim[0] >= 1 && raw->dim[0] <= 7 ? raw->dim[0] : 0;
    while (axes > 3 && raw->dim[axes] == 1) {
        axes--;
    }
    if (axes != 3) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte 40: its array has %d axes and a volume has 3", path, axes);
    }
    if (raw->dim[1] < 1 || raw->dim[2] < 1 || raw->dim[3] < 1) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: has no voxels: its extents are %d x %d x %d; save it again", path,
                       raw->dim[1], raw->dim[2], raw->dim[3]);
    }
    return MS_OK;
}

/* From voxels to space: sform before qform, as the standard advises; without both, the spacings alone. */
static ms_status set_space(ms_volume_header *header, const nifti_image *image, const char *path, ms_error *err)
{
    const mat44 *m = image->sform_code > 0 ? &image->sto_xyz : &image->qto_xyz;
    double direction[3][3];
    for (int f = 0; f < 3; f++) {
        for (int a = 0; a < 3; a++) {
            direction[f][a] = (double)m->m[a][f];
        }
    }
    if (!ms_volume_header_set_axes(header, (const double(*)[3])direction)) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: its axes are oblique by its %s; resample it to axes along x, y and z",
                       path, image->sform_code > 0 ? "sform" : "qform");
    }
    for (int f = 0; f < 3; f++) {
        header->spacing[f] = fabs(direction[f][header->axis[f]]);
        header->origin[f] = (double)m->m[f][3];
    }
    return MS_OK;
}

static ms_status read_header(ms_volume_header *header, const nifti_image *image, const char *path, ms_error *err)
{
    header->n[0] = image->nx;
    header->n[1] = image->ny;
    header->n[2] = image->nz;
    if (image->scl_slope != 0) { /* 0: none */
        header->slope = (double)image->scl_slope;
        header->intercept = (double)image->scl_inter;
    }
    const ms_status status = find_sample(&header->sample, image->datatype, path, err);
    return status == MS_OK ? set_space(header, image, path, err) : status;
}

ms_status ms_volume_parse_nifti(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                                ms_error *err)
{
    nifti_1_header raw;
    ms_volume_header header = ms_volume_header_start(max_voxels);
    int is_swapped = 0;
    *stored = (ms_stored){0};
    ms_status status = load_header(&raw, &is_swapped, bytes, path, err);
    if (status != MS_OK) {
        return status;
    }
    const double begin = (double)raw.vox_offset;
    if (!(begin >= (double)sizeof raw + 4 && begin <= (double)bytes->size && begin == floor(begin))) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: byte 108: its voxels cannot begin at %g of %zu bytes; save it again",
                       path, begin, bytes->size);
    }
    ms_sample known;
    status = find_sample(&known, raw.datatype, path, err);
    nifti_image *image = status == MS_OK ? nifti_convert_nhdr2nim(raw, NULL) : NULL;
    if (status == MS_OK && !image) {
        return ms_fail(err, MS_ERR_FORMAT, "%s: the nifti library does not take its header; save it again", path);
    }
    if (status == MS_OK) {
        header.big_endian = is_swapped != ms_volume_is_big_endian();
        status = read_header(&header, image, path, err);
        nifti_image_free(image);
    }
    return status == MS_OK
               ? ms_volume_store(stored, &header, bytes->data + (size_t)begin, bytes->size - (size_t)begin, path, err)
               : status;
}

#else

ms_status ms_volume_parse_nifti(ms_stored *stored, const ms_bytes *bytes, const char *path, size_t max_voxels,
                                ms_error *err)
{
    (void)bytes;
    (void)max_voxels;
    *stored = (ms_stored){0};
    return ms_fail(err, MS_ERR_FORMAT,
                   "%s: NIfTI is not read by this mskit, which was built without the nifti library; build it with "
                   "libnifti-dev (-Dnifti=enabled), or save the volume as .npy or .nrrd",
                   path);
}

#endif
