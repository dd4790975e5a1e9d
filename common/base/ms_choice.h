/** A word that a user typed, held against the words of a closed list; where it is none of them, which was meant.
 * Private. */
#ifndef MS_CHOICE_H
#define MS_CHOICE_H

#include <stddef.h>

#include "ms_error.h"

enum { MS_CHOICE_LONGEST = 256 }; /* words from this length on are near to none */

/** Begins as {.typed = word}. */
typedef struct ms_choice {
    const char *typed;               /* borrowed */
    size_t length;                   /* of it, where it ends before its 0 byte; else 0 */
    char list[512];                  /* the words offered, with commas between; cut if there are many */
    char nearest[MS_CHOICE_LONGEST]; /* "" if none is near */
    size_t distance;                 /* of that */
} ms_choice;

/** Which word was meant, as part of a message: "; did you mean dice?", or "". */
typedef struct ms_hint {
    char text[MS_CHOICE_LONGEST + 24];
} ms_hint;

/**
 * Offers a word of the list. A word is near that takes few edits in proportion to its length, capitals aside, or that
 * the user began; among equally near ones the first.
 *
 * @return nonzero if it is the word that was typed
 * Cost: O(length of both).
 */
int ms_choice_offer(ms_choice *choice, const char *word);

/** The same of a word that is not ended by a 0 byte. */
int ms_choice_offer_part(ms_choice *choice, const char *word, size_t length);

ms_hint ms_choice_hint(const ms_choice *choice);

/** The same of the names in the folder of a file that is not there. Cost: O(names log names). */
ms_hint ms_choice_file_hint(const char *path);

/**
 * Writes what the format says, then the hint, then the list, "none" if nothing was offered.
 * @return MS_ERR_ARG
 */
ms_status ms_choice_fail(const ms_choice *choice, ms_error *err, const char *format, ...) MS_PRINTF(3, 4);

/**
 * Number of edits that make one word of another: a letter put in, left out or replaced, or two neighbours exchanged;
 * capitals count as small letters.
 *
 * @param n, m lengths, below MS_CHOICE_LONGEST
 *
 * Source: Damerau, A technique for computer detection and correction of spelling errors, Commun. ACM 7 (1964) 171; by
 * the recurrence of Wagner & Fischer, J. ACM 21 (1974) 168. Cost: O(n m).
 */
size_t ms_choice_distance(const char *a, size_t n, const char *b, size_t m);

#endif
