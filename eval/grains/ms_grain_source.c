#include "ms_grain_source.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

ms_status ms_grain_source_begin(ms_grain_source *source, const char *path, ms_error *err)
{
    struct stat info;
    memset(source, 0, sizeof *source);
    source->path = strdup(path);
    source->is_volume = ms_volume_is_volume_path(path);
    source->cause = source->is_volume ? malloc(sizeof *source->cause) : NULL;
    if (!source->path || (source->is_volume && !source->cause)) {
        free(source->path);
        free(source->cause);
        return ms_fail(err, MS_ERR_NOMEM, "no memory for the name of a grain");
    }
    source->bytes = stat(path, &info) == 0 ? (double)info.st_size : 0;
    pthread_mutex_init(&source->lock, NULL);
    return MS_OK;
}

static void close_volume(ms_grain_source *source)
{
    ms_scan_close(&source->scan);
    source->is_kept = 0;
}

void ms_grain_source_list(ms_grain_source *source, const ms_input_flags *flags, double most)
{
    source->status = ms_input_volume_open(&source->scan, &source->labels, &source->origin, source->path, &flags->scan,
                                          ms_input_max_voxels(flags), source->cause);
    source->checksum = source->scan.checksum;
    source->is_kept = source->status == MS_OK;
    if (source->is_kept && (double)source->scan.held > most) {
        close_volume(source);
    }
}

/* Has the volume open. */
static ms_status need_volume(ms_grain_source *source, const ms_input_flags *flags, ms_queue_place *place, ms_error *err)
{
    while (pthread_mutex_trylock(&source->lock) != 0) { /* another grain reads it */
        ms_queue_pause(place);
        pthread_mutex_lock(&source->lock);
        pthread_mutex_unlock(&source->lock);
        ms_queue_resume(place); /* not under the lock, which a grain that is alone may need */
    }
    if (source->status == MS_OK && !source->is_kept) {
        source->status =
            ms_scan_open(&source->scan, source->path, &flags->scan, ms_input_max_voxels(flags), source->cause);
        source->is_kept = source->status == MS_OK;
    }
    const ms_status status = source->status;
    if (status != MS_OK) {
        *err = *source->cause;
    }
    pthread_mutex_unlock(&source->lock);
    return status;
}

ms_status ms_grain_source_read(ms_grain_source *source, ms_input *input, uint32_t label, const ms_input_flags *flags,
                               ms_queue_place *place, ms_error *err)
{
    if (!source->is_volume) {
        return ms_input_read(input, source->path, flags, err);
    }
    const double start = omp_get_wtime();
    memset(input, 0, sizeof *input);
    input->path = source->path;
    input->checksum = source->checksum;
    input->origin = source->origin;
    input->is_volume = 1;
    ms_status status = need_volume(source, flags, place, err);
    if (status != MS_OK) {
        return status;
    }
    const ms_label_entry *entry = ms_labels_entry(&source->labels, label);
    status = entry ? ms_labels_crop_scan(&input->volume, &source->scan, entry, err)
                   : ms_fail(err, MS_ERR_SHAPE, "%s: no voxel has the label %lu", source->path, (unsigned long)label);
    input->read_seconds = omp_get_wtime() - start;
    return status;
}

void ms_grain_source_release(ms_grain_source *source)
{
    pthread_mutex_lock(&source->lock);
    const int is_last = --source->users == 0;
    pthread_mutex_unlock(&source->lock);
    if (is_last) {
        close_volume(source);
    }
}

void ms_grain_source_end(ms_grain_source *source)
{
    if (source->path) {
        pthread_mutex_destroy(&source->lock);
    }
    free(source->path);
    free(source->cause);
    ms_labels_free(&source->labels);
    ms_scan_close(&source->scan);
    memset(source, 0, sizeof *source);
}
