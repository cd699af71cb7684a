/* A client built on the generated C code: it makes the calls of calls_c.txt over TCP.
 * Each defect is a flag of the compiler (-DDEFECT_...). */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "mycobot.h"

enum { PATIENCE_MS = 170, ATTEMPTS = 3 };

static int line;
static mycobot_any_t any;

/* Wait for the reply; return whether it came. */
static int replied(mycobot_message_t wanted)
{
    mycobot_framer_t framer;
    mycobot_event_t event;
    mycobot_message_t message;
    mycobot_any_t reply;
    struct pollfd waiting;
    uint8_t data[256];

    waiting.fd = line;
    waiting.events = POLLIN;
    mycobot_framer_init(&framer, MYCOBOT_LISTEN_REPLIES, false);
    while (poll(&waiting, 1, PATIENCE_MS) > 0) {
        const ssize_t size = read(line, data, sizeof data);
        ssize_t fed = 0;
        if (size <= 0) {
            exit(1);
        }
        while (fed < size) {
            fed += (ssize_t)mycobot_framer_feed(&framer, data + fed, (size_t)(size - fed));
            while (mycobot_framer_next(&framer, &event)) {
                if (event.reason == MYCOBOT_OK
                    && !mycobot_read(MYCOBOT_LISTEN_REPLIES, event.data, event.size, &message,
                        &reply, NULL)
                    && message == wanted) {
                    return 1;
                }
            }
        }
    }
    return 0;
}

static void send_frame(mycobot_message_t message)
{
    uint8_t data[MYCOBOT_LONGEST_FRAME] = {0};
    size_t size;

    if (mycobot_encode(message, &any, data, sizeof data, &size, NULL)) {
        exit(1);
    }
#if defined DEFECT_WHOLE_BUFFER_SENT
    size = sizeof data;
#elif defined DEFECT_LAST_BYTE_NOT_SENT
    size -= message == MYCOBOT_SET_COLOR_REQUEST;
#endif
    if (write(line, data, size) < 0) {
        exit(1);
    }
}

static void ask(mycobot_message_t request, mycobot_message_t reply)
{
    int attempt;
    for (attempt = 0; attempt < ATTEMPTS; attempt++) {
        send_frame(request);
#ifdef DEFECT_DOES_NOT_WAIT
        return;
#endif
        if (replied(reply)) {
            return;
        }
    }
}

static mycobot_raw_t angle(double degrees)
{
    mycobot_raw_t raw = 0;
#ifdef DEFECT_CASTS_TO_INT
    raw = (mycobot_raw_t)(degrees * 100);
#else
    if (!mycobot_angle_from_degree(degrees, &raw)) {
        exit(1);
    }
#endif
    return raw;
}

static void tell(mycobot_message_t request)
{
    send_frame(request);
    usleep(4000);
}

int main(int count, char **arguments)
{
    static const double pose[6] = {8.03, -20.5, 33.33, -45, 60, -70.07};
    struct sockaddr_in there;
    int i, on = 1;

    memset(&there, 0, sizeof there);
    there.sin_family = AF_INET;
    there.sin_port = htons((uint16_t)atoi(count > 1 ? arguments[1] : "0"));
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    line = socket(AF_INET, SOCK_STREAM, 0);
    if (line < 0 || connect(line, (struct sockaddr *)&there, sizeof there)) {
        return 1;
    }
    setsockopt(line, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    tell(MYCOBOT_POWER_ON_REQUEST);
    ask(MYCOBOT_GET_ANGLES_REQUEST, MYCOBOT_GET_ANGLES_REPLY);
    for (i = 0; i < 6; i++) {
#ifdef DEFECT_LAST_JOINT_FORGOTTEN
        any.send_angles_request.angles[i] = i < 5 ? angle(pose[i]) : 0;
#else
        any.send_angles_request.angles[i] = angle(pose[i]);
#endif
    }
    any.send_angles_request.speed = 40;
    tell(MYCOBOT_SEND_ANGLES_REQUEST);
    ask(MYCOBOT_IS_MOVING_REQUEST, MYCOBOT_IS_MOVING_REPLY);
    any.set_color_request.red = 10;
    any.set_color_request.green = 20;
    any.set_color_request.blue = 30;
    tell(MYCOBOT_SET_COLOR_REQUEST);
    ask(MYCOBOT_GET_COORDS_REQUEST, MYCOBOT_GET_COORDS_REPLY);
    tell(MYCOBOT_STOP_REQUEST);
    return 0;
}
