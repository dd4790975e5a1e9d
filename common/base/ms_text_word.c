/* One word of a text. */
#include <string.h>

#include "ms_text.h"

int ms_text_word_is(const ms_word *word, const char *lower)
{
    size_t i = 0;
    for (; i < word->length && lower[i]; i++) {
        char c = word->start[i];
        if (c >= 'A' && c <= 'Z') {
            c = (char)(c - 'A' + 'a');
        }
        if (c != lower[i]) {
            return 0;
        }
    }
    return i == word->length && lower[i] == '\0';
}

ms_quote ms_text_quote(const ms_word *word)
{
    ms_quote quote;
    size_t room = sizeof quote.text - 4;
    size_t length = word->length < room ? word->length : room;
    for (size_t i = 0; i < length; i++) {
        char c = word->start[i];
        quote.text[i] = (char)(c >= ' ' && c <= '~' ? c : '?');
    }
    strcpy(quote.text + length, word->length > room ? "..." : "");
    return quote;
}
