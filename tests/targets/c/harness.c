/* Runs an edition's C code on operations from standard input, in native byte order. Each input has
 * memory of exactly its size, so that the sanitizers detect every access beyond it. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "floats.h"
#include "physical.h"

#define UNTOUCHED 0xA5
#define JOINED(a, b) a##b
#define NAME(a, b) JOINED(a, b)
#define P(name) NAME(PREFIX, name)

static void take(void *to, size_t size)
{
    if (fread(to, 1, size, stdin) != size) {
        exit(2);
    }
}

static void give(const void *from, size_t size)
{
    fwrite(from, 1, size, stdout);
}

static unsigned take_u16(void)
{
    uint16_t value;
    take(&value, sizeof value);
    return value;
}

static void give_u16(size_t value)
{
    const uint16_t word = (uint16_t)value;
    give(&word, sizeof word);
}

static uint8_t *take_bytes(size_t size)
{
    uint8_t *bytes = malloc(size ? size : 1);
    if (!bytes) {
        exit(3);
    }
    take(bytes, size);
    return bytes;
}

static void give_outcome(unsigned status, const P(fault_t) *fault)
{
    give_u16(status);
    give_u16(fault->message);
    give_u16(fault->field);
    give_u16(fault->element);
    give_u16(fault->offset);
}

static void give_numbers(unsigned message, const P(any_t) *any)
{
    int64_t raw[NUMBERS] = {0};
    double physical[NUMBERS] = {0};
    const size_t count = to_numbers(message, any, raw, physical);
    size_t i;

    give_u16(count);
    for (i = 0; i < count; i++) {
        give(&raw[i], sizeof raw[i]);
        give(&physical[i], sizeof physical[i]);
    }
}

/* Take as many numbers as are sent: raw values, then physical values. */
static void encode(void)
{
    const unsigned message = take_u16(), address = take_u16(), room = take_u16();
    const bool from_values = take_u16() != 0;
    const size_t count = take_u16();
    P(any_t) any;
    P(fault_t) fault = {0, 0, 0, 0};
    uint8_t *out = malloc(room ? room : 1);
    int64_t raw[NUMBERS];
    double physical[NUMBERS];
    size_t size = 0;
    unsigned status;

    if (!out || count > NUMBERS) {
        exit(3);
    }
    take(raw, count * sizeof raw[0]);
    take(physical, count * sizeof physical[0]);
    from_numbers(message, from_values, raw, physical, &any);
    status = typed_encode(message, (uint8_t)address, &any, out, room, &size, &fault);
    give_outcome(status, &fault);
    give_u16(size);
    give(out, size);
    free(out);
}

/* A rejected frame must leave the struct unchanged. */
static void check_untouched(const void *memory, size_t size)
{
    for (; size != 0; size--) {
        if (((const uint8_t *)memory)[size - 1] != UNTOUCHED) {
            fprintf(stderr, "a rejected frame changed the struct\n");
            exit(5);
        }
    }
}

static void decode(bool as_one)
{
    unsigned message = take_u16();
    const size_t size = take_u16();
    uint8_t *data = take_bytes(size);
    P(any_t) any;
    P(fault_t) fault = {0, 0, 0, 0};
    unsigned status;

    memset(&any, UNTOUCHED, sizeof any);
    if (as_one) {
        status = typed_decode(message, data, size, &any, &fault);
    } else {
        P(message_t) found;
        status = P(read)((P(listening_t))message, data, size, &found, &any, &fault);
        message = (unsigned)found;
    }
    give_outcome(status, &fault);
    give_u16(message);
    if (status == 0) {
        give_numbers(message, &any);
    } else {
        check_untouched(&any, sizeof any);
    }
    free(data);
}

static void give_events(P(framer_t) *framer)
{
    P(event_t) event;
    uint16_t one = 1;

    while (P(framer_next)(framer, &event)) {
        give_u16(one);
        give_u16(event.reason);
        give(&event.offset, sizeof event.offset);
        give_u16(event.size);
        give(event.data, event.size);
    }
}

static void frame(void)
{
    const unsigned listening = take_u16(), accept_unknown = take_u16();
    unsigned chunks = take_u16();
    P(framer_t) *framer = malloc(sizeof *framer);

    if (!framer) {
        exit(3);
    }
    P(framer_init)(framer, (P(listening_t))listening, accept_unknown != 0);
    for (; chunks != 0; chunks--) {
        const bool flush = take_u16() != 0;
        const size_t size = take_u16();
        uint8_t *data = take_bytes(size);
        size_t fed = 0;
        while (fed < size) {
            fed += P(framer_feed)(framer, data + fed, size - fed);
            give_events(framer);
        }
        if (flush) {
            P(framer_flush)(framer);
            give_events(framer);
        }
        give_u16(0);
        free(data);
    }
    give_u16(P(framer_pending)(framer));
    free(framer);
}

static void give_names(void)
{
    unsigned message, field;

    for (message = 0; message < MESSAGES; message++) {
        printf("%s", P(message_name)((P(message_t))message));
        for (field = 0; *P(field_name)((P(message_t))message, (uint8_t)field); field++) {
            printf(" %s", P(field_name)((P(message_t))message, (uint8_t)field));
        }
        printf("\n");
    }
    printf("\n");
}

int main(void)
{
    int operation;

    while ((operation = getchar()) != EOF) {
        switch (operation) {
        case 'e': encode(); break;
        case 'd': decode(true); break;
        case 'r': decode(false); break;
        case 'f': frame(); break;
        case 'n': give_names(); break;
        default: return 4;
        }
        fflush(stdout);
    }
    return 0;
}
