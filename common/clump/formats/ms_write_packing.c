#include "ms_write_packing.h"

#include <stdlib.h>
#include <string.h>

#include "base/ms_file.h"

int ms_write_packing_is(const ms_format *format)
{
    return format->packing[0].suffix != NULL;
}

static ms_status write_packing_part(const ms_packing *packing, const char *path, const ms_packing_part *part,
                                    ms_error *err)
{
    const size_t size = strlen(path) + strlen(part->suffix) + 1;
    char *file = malloc(size);
    ms_output output;
    if (!file) {
        return ms_fail(err, MS_ERR_NOMEM, "%s: no memory to write it", path);
    }
    snprintf(file, size, "%s%s", path, part->suffix);
    ms_status status = ms_output_open(&output, file, err);
    if (status == MS_OK) {
        status = part->write(output.stream, packing, ms_file_base_name(path), err);
        status = ms_output_close(&output, status, err);
    }
    free(file);
    return status;
}

static ms_status write_packing_parts(const ms_packing *packing, const char *path, const ms_packing_part *part,
                                     ms_error *err)
{
    ms_status status = MS_OK;
    for (; part->suffix && status == MS_OK; part++) {
        status = write_packing_part(packing, path, part, err);
    }
    return status;
}

ms_status ms_write_packing(const ms_packing *packing, const char *path, const ms_format *format, ms_error *err)
{
    return write_packing_parts(packing, path, format->packing, err);
}

ms_status ms_write_mixture(const ms_packing *mixture, const char *path, const ms_format *format, ms_error *err)
{
    return write_packing_parts(mixture, path, format->mixture, err);
}

ms_status ms_write_scene(const ms_packing *scene, const char *path, const ms_format *format, ms_error *err)
{
    return write_packing_part(scene, path, &format->scene, err);
}
