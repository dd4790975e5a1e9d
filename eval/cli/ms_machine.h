/** On which machine times were measured. */
#ifndef MS_MACHINE_H
#define MS_MACHINE_H

typedef struct ms_machine {
    char text[128]; /* "PROCESSOR, N cores" */
} ms_machine;

/** The processor as Linux names it, elsewhere the kind of machine, and how many cores are on line. */
ms_machine ms_machine_read(void);

#endif
