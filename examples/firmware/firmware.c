/*
 * A firmware that runs on a PC: it speaks the protocol of the myCobot 280 on a pseudo-terminal.
 *
 *     cobotwire-gen build arm280.yaml --out arm280 --c generated
 *     cc -std=c99 -Igenerated firmware.c generated/arm280.c -o firmware
 *     ./firmware                                 # prints the port
 *     cobotwire call PORT get_angles             # in another terminal
 *
 * It reaches each target at once, and handles four commands. cobotwire-gen wrote arm280.h and
 * arm280.c from the spec. On a microcontroller, only main(), line_read() and line_write() differ.
 */
#define _XOPEN_SOURCE 600

#include "arm280.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int line;
static int32_t angles[6]; /* in steps of 1/100 degree, as on the wire */
static uint8_t powered;

static size_t line_read(uint8_t *data, size_t size)
{
    const ssize_t got = read(line, data, size);
    return got > 0 ? (size_t)got : 0;
}

static void line_write(const uint8_t *data, size_t size)
{
    if (write(line, data, size) != (ssize_t)size) {
        perror("write");
    }
}

/* Reply to one request. Like the arm, ignore unknown requests. */
static void serve(arm280_message_t message, const arm280_any_t *request)
{
    uint8_t out[ARM280_LONGEST_FRAME];
    size_t size = 0;

    switch (message) {
    case ARM280_POWER_ON_REQUEST:
        powered = 1;
        return;
    case ARM280_IS_POWER_ON_REQUEST: {
        const arm280_is_power_on_reply_t reply = {.powered = powered};
        arm280_encode_is_power_on_reply(&reply, out, sizeof out, &size, NULL);
        break;
    }
    case ARM280_SEND_ANGLES_REQUEST:
        for (int i = 0; i < 6 && powered; i++) {
            angles[i] = request->send_angles_request.angles[i];
        }
        return;
    case ARM280_GET_ANGLES_REQUEST: {
        arm280_get_angles_reply_t reply;
        for (int i = 0; i < 6; i++) {
            reply.angles[i] = angles[i];
        }
        arm280_encode_get_angles_reply(&reply, out, sizeof out, &size, NULL);
        break;
    }
    default:
        return;
    }
    line_write(out, size);
}

static void handle(const arm280_event_t *event)
{
    arm280_message_t message;
    arm280_any_t request;

    if (event->reason == ARM280_OK /* otherwise noise */
        && arm280_read(ARM280_LISTEN_REQUESTS, event->data, event->size, &message, &request, NULL)
               == ARM280_OK) {
        serve(message, &request);
    }
}

int main(void)
{
    arm280_framer_t framer;
    arm280_event_t event;
    uint8_t byte;

    line = posix_openpt(O_RDWR | O_NOCTTY);
    if (line < 0 || grantpt(line) || unlockpt(line)) {
        perror("no pseudo-terminal");
        return 1;
    }
    /* Keep the other end open, so that the port remains when a client closes it. */
    if (open(ptsname(line), O_RDWR | O_NOCTTY) < 0) {
        perror(ptsname(line));
        return 1;
    }
    puts(ptsname(line));
    fflush(stdout);
    arm280_framer_init(&framer, ARM280_LISTEN_REQUESTS, false);
    while (line_read(&byte, 1)) {
        arm280_framer_feed(&framer, &byte, 1);
        while (arm280_framer_next(&framer, &event)) {
            handle(&event);
        }
    }
    return 0;
}
