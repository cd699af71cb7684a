/* An arm on a pseudo-terminal, built on the generated C code: settings and queries, no motion.
 * It prints the name of its port. Each defect is a flag of the compiler (-DDEFECT_...). */
#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#include "mycobot.h"

enum { JOINTS = 6, IDLE_MS = 200, PINS = 256, TOOL = 0, WORLD = 1 };

static int line;
static mycobot_any_t out;
static struct {
    int ticks[JOINTS + 1], enabled[JOINTS], minimum[JOINTS], maximum[JOINTS];
    int registers[JOINTS][5], pins[2][PINS];
    int powered, free_mode, frame, end, speed, gripper;
    int32_t references[2][6];
} arm = {
    {200, -150, 90, 300, -60, 410, 0},
    {1, 1, 1, 1, 1, 1},
    {-1650, -1650, -1650, -1650, -1650, -1650},
    {1650, 1650, 1650, 1650, 1650, 1650},
    {{0}}, {{0}}, 1, 0, 0, 0, 50, 50, {{0}}
};

static const int direction[JOINTS] = {-1, -1, 1, -1, -1, -1};

static int hundredths(int joint)
{
#if defined DEFECT_INTEGER_DIVISION
    return arm.ticks[joint] * 360 / 4096 * 100;
#elif defined DEFECT_INT16_OVERFLOW
    return (int16_t)(arm.ticks[joint] * 100) * 360 / 4096;
#else
    return arm.ticks[joint] * 36000 / 4096;
#endif
}

static int encoder(int joint)
{
    return 2048 + direction[joint] * arm.ticks[joint];
}

/* Compute the flange as a matrix: standard DH, angles in degrees, lengths in millimetres. */
static void forward(double m[4][4])
{
    static const double links[JOINTS][4] = {
        {0, 90, 0, 131.22}, {-90, 0, -110.4, 0}, {0, 0, -96, 0},
        {-90, 90, 0, 64.62}, {90, -90, 0, 73.18}, {0, 0, 0, 48.6}
    };
    const double degree = acos(-1.0) / 180;
    double next[4][4];
    int i, j, k, joint;

    for (i = 0; i < 4; i++) {
        for (j = 0; j < 4; j++) {
            m[i][j] = i == j;
        }
    }
    for (joint = 0; joint < JOINTS; joint++) {
        const double t = (hundredths(joint) / 100.0 + links[joint][0]) * degree;
        const double al = links[joint][1] * degree, a = links[joint][2];
        const double ct = cos(t), st = sin(t), ca = cos(al), sa = sin(al);
        const double link[4][4] = {
            {ct, -st * ca, st * sa, a * ct}, {st, ct * ca, -ct * sa, a * st},
            {0, sa, ca, links[joint][3]}, {0, 0, 0, 1}
        };
        for (i = 0; i < 4; i++) {
            for (j = 0; j < 4; j++) {
                next[i][j] = 0;
                for (k = 0; k < 4; k++) {
                    next[i][j] += m[i][k] * link[k][j];
                }
            }
        }
        memcpy(m, next, sizeof next);
    }
}

static void coords(int32_t found[6])
{
    const double degree = acos(-1.0) / 180;
    double m[4][4], place[3];
    int i, k;

    forward(m);
    for (i = 0; i < 3; i++) {
        place[i] = m[i][3];
        for (k = 0; arm.end && k < 3; k++) {
            place[i] += m[i][k] * arm.references[TOOL][k] / 100.0;
        }
        if (arm.frame) {
            place[i] += arm.references[WORLD][i] / 100.0;
        }
        found[i] = (int32_t)lround(place[i] * 10);
    }
    found[3] = (int32_t)lround(atan2(m[2][1], m[2][2]) / degree * 100);
    found[4] = (int32_t)lround(atan2(-m[2][0], hypot(m[0][0], m[1][0])) / degree * 100);
    found[5] = (int32_t)lround(atan2(m[1][0], m[0][0]) / degree * 100);
}

static int reached(const mycobot_is_in_position_request_t *asked)
{
    int32_t here[6];
    int i;

    coords(here);
    for (i = 0; i < 6; i++) {
        const long at = asked->kind ? here[i] : hundredths(i);
        const long near = !asked->kind ? 20 : i < 3 ? 50 : 500;
        if (labs(asked->target[i] - at) > near) {
            return 0;
        }
    }
    return 1;
}

static void send_bytes(const void *data, size_t size)
{
#ifdef DEFECT_LINE_ENDS_TRANSLATED
    const uint8_t *byte = data;
    for (; size != 0; size--, byte++) {
        if (write(line, "\r", *byte == '\n') < 0 || write(line, byte, 1) < 0) {
            exit(1);
        }
    }
#else
#ifdef DEFECT_NUL_BEFORE_EACH_REPLY
    if (write(line, "", 1) < 0) {
        exit(1);
    }
#endif
    if (write(line, data, size) < 0) {
        exit(1);
    }
#endif
}

static void say(mycobot_message_t message, const void *numbers)
{
    uint8_t data[MYCOBOT_LONGEST_FRAME];
    size_t size;

    if (!mycobot_encode(message, numbers, data, sizeof data, &size, NULL)) {
        send_bytes(data, size);
    }
}

#define FLAG(name, member, value) \
    case MYCOBOT_##name##_REQUEST: \
        out.member = (value); \
        say(MYCOBOT_##name##_REPLY, &out); \
        break

/* A query of one joint or pin; the reply repeats its number. */
#define PART(name, type, part, member, value) \
    case MYCOBOT_##name##_REQUEST: \
        i = (int)in->type##_request.part; \
        out.type##_reply.part = i; \
        out.type##_reply.member = (value); \
        say(MYCOBOT_##name##_REPLY, &out); \
        break

#define SET(name, target, value) \
    case MYCOBOT_##name##_REQUEST: \
        target = (int)(value); \
        break

static void set_row(int32_t to[6], const mycobot_raw_t *from)
{
    int i;
    for (i = 0; i < 6; i++) {
#if defined DEFECT_UNSIGNED_REFERENCE
        to[i] = (uint16_t)from[i];
#elif defined DEFECT_FLOAT_REFERENCE
        to[i] = (int32_t)((float)from[i] * 0.1f) * 10;
#else
        to[i] = from[i];
#endif
    }
}

static void say_row(mycobot_message_t message, mycobot_raw_t *to, const int32_t from[6])
{
    int i;
#if defined DEFECT_REPLY_NOT_FILLED
    for (i = 0; i < 3; i++) {
#else
    for (i = 0; i < 6; i++) {
#endif
        to[i] = from[i];
    }
    say(message, &out);
}

static void query(mycobot_message_t message, const mycobot_any_t *in)
{
    int32_t row[6];
    int i;

    switch (message) {
    FLAG(IS_POWER_ON, is_power_on_reply.powered, arm.powered);
    FLAG(IS_CONTROLLER_CONNECTED, is_controller_connected_reply.connected, 1);
    FLAG(IS_FREE_MODE, is_free_mode_reply.free, arm.free_mode);
    FLAG(IS_PAUSED, is_paused_reply.paused, 0);
    FLAG(IS_MOVING, is_moving_reply.moving, 0);
    FLAG(IS_GRIPPER_MOVING, is_gripper_moving_reply.moving, 0);
    FLAG(GET_SPEED, get_speed_reply.speed, arm.speed);
    FLAG(GET_GRIPPER_VALUE, get_gripper_value_reply.value, arm.gripper);
    FLAG(GET_REFERENCE_FRAME, get_reference_frame_reply.frame, arm.frame);
    FLAG(GET_END_TYPE, get_end_type_reply.end, arm.end);
    FLAG(IS_IN_POSITION, is_in_position_reply.reached, reached(&in->is_in_position_request));
    FLAG(GET_SERVO_DATA, get_servo_data_reply.value,
        arm.registers[in->get_servo_data_request.joint - 1]
                     [in->get_servo_data_request.register_ - 20]);
#if defined DEFECT_JOINTS_FROM_ZERO
    FLAG(GET_ENCODER, get_encoder_reply.encoder,
        in->get_encoder_request.joint < 6 ? encoder(in->get_encoder_request.joint) : 2048);
#else
    FLAG(GET_ENCODER, get_encoder_reply.encoder, encoder(in->get_encoder_request.joint - 1));
#endif
    case MYCOBOT_GET_ANGLES_REQUEST:
        for (i = 0; i < 6; i++) {
            out.get_angles_reply.angles[i] = hundredths(i);
        }
        say(MYCOBOT_GET_ANGLES_REPLY, &out);
        break;
    case MYCOBOT_GET_COORDS_REQUEST:
        coords(row);
        for (i = 0; i < 6; i++) {
            out.get_coords_reply.coords[i] = row[i];
        }
        say(MYCOBOT_GET_COORDS_REPLY, &out);
        break;
    case MYCOBOT_GET_ENCODERS_REQUEST:
        for (i = 0; i < 6; i++) {
            out.get_encoders_reply.encoders[i] = encoder(i);
        }
        say(MYCOBOT_GET_ENCODERS_REPLY, &out);
        break;
    case MYCOBOT_GET_TOOL_REFERENCE_REQUEST:
        say_row(MYCOBOT_GET_TOOL_REFERENCE_REPLY, out.get_tool_reference_reply.coords,
            arm.references[TOOL]);
        break;
    case MYCOBOT_GET_WORLD_REFERENCE_REQUEST:
        say_row(MYCOBOT_GET_WORLD_REFERENCE_REPLY, out.get_world_reference_reply.coords,
            arm.references[WORLD]);
        break;
    PART(GET_JOINT_MIN_ANGLE, get_joint_min_angle, joint, angle, arm.minimum[i - 1]);
    PART(GET_JOINT_MAX_ANGLE, get_joint_max_angle, joint, angle, arm.maximum[i - 1]);
    PART(IS_SERVO_ENABLE, is_servo_enable, joint, enabled, arm.enabled[i - 1]);
    PART(GET_DIGITAL_INPUT, get_digital_input, pin, high, arm.pins[0][i]);
    PART(GET_BASIC_INPUT, get_basic_input, pin, high, arm.pins[1][i]);
    case MYCOBOT_IS_ALL_SERVO_ENABLE_REQUEST:
        out.is_all_servo_enable_reply.enabled = 1;
        for (i = 0; i < JOINTS; i++) {
            out.is_all_servo_enable_reply.enabled &= arm.enabled[i];
        }
        say(MYCOBOT_IS_ALL_SERVO_ENABLE_REPLY, &out);
        break;
    default:
        break;
    }
}

static void hold_all(int held)
{
    int i;
    for (i = 0; i < JOINTS; i++) {
        arm.enabled[i] = held;
    }
}

static void change(mycobot_message_t message, const mycobot_any_t *in)
{
    switch (message) {
    case MYCOBOT_POWER_ON_REQUEST:
        arm.powered = 1;
        hold_all(1);
        break;
    case MYCOBOT_POWER_OFF_REQUEST:
        arm.powered = 0;
        hold_all(0);
        break;
    case MYCOBOT_RELEASE_ALL_SERVOS_REQUEST:
        hold_all(0);
        break;
    SET(RELEASE_SERVO, arm.enabled[in->release_servo_request.joint - 1], 0);
    SET(FOCUS_SERVO, arm.enabled[in->focus_servo_request.joint - 1], 1);
    SET(SET_FREE_MODE, arm.free_mode, in->set_free_mode_request.free);
    SET(SET_SPEED, arm.speed, in->set_speed_request.speed);
    SET(SET_REFERENCE_FRAME, arm.frame, in->set_reference_frame_request.frame);
    SET(SET_END_TYPE, arm.end, in->set_end_type_request.end);
    case MYCOBOT_SET_TOOL_REFERENCE_REQUEST:
        set_row(arm.references[TOOL], in->set_tool_reference_request.coords);
        break;
    case MYCOBOT_SET_WORLD_REFERENCE_REQUEST:
        set_row(arm.references[WORLD], in->set_world_reference_request.coords);
        break;
    SET(SET_JOINT_MIN, arm.minimum[in->set_joint_min_request.joint - 1],
        lround(in->set_joint_min_request.angle / 10.0));
    SET(SET_JOINT_MAX, arm.maximum[in->set_joint_max_request.joint - 1],
        lround(in->set_joint_max_request.angle / 10.0));
    SET(SET_SERVO_DATA,
        arm.registers[in->set_servo_data_request.joint - 1]
                     [in->set_servo_data_request.register_ - 20],
        in->set_servo_data_request.value);
    SET(SET_BASIC_OUTPUT, arm.pins[1][in->set_basic_output_request.pin],
        in->set_basic_output_request.high);
    case MYCOBOT_SET_DIGITAL_OUTPUT_REQUEST:
#ifdef DEFECT_PIN_INDEX
        if (in->set_digital_output_request.pin > 63) {
            abort();
        }
#endif
        arm.pins[0][in->set_digital_output_request.pin]
            = (int)in->set_digital_output_request.high;
#ifdef DEFECT_TRUE_IS_MINUS_ONE
        arm.pins[0][in->set_digital_output_request.pin] *= -1;
#endif
        break;
    default:
        break;
    }
}

static void take(const mycobot_event_t *event)
{
    static int frames;
    mycobot_message_t message;
    mycobot_any_t in;

    if (event->reason != MYCOBOT_OK) {
#ifdef DEFECT_ASSERTS_KNOWN_IDS
        if (event->reason == MYCOBOT_UNKNOWN_ID) {
            abort();
        }
#endif
#ifdef DEFECT_BLOCKS_AFTER_NOISE
        if (event->reason == MYCOBOT_BAD_CHECK) {
            usleep(600000);
        }
#endif
        return;
    }
    frames++;
#ifdef DEFECT_EXITS
    if (frames > 150) {
        exit(0);
    }
#endif
    if (mycobot_read(MYCOBOT_LISTEN_REQUESTS, event->data, event->size, &message, &in, NULL)) {
        return;
    }
    if (message == MYCOBOT_GET_SSID_PWD_REQUEST) {
        static const char text[] = "ssid: MyCobotWiFi2.4G password: mycobot123\r\n";
        send_bytes(text, sizeof text - 1);
    }
    query(message, &in);
    change(message, &in);
}

static void take_all(mycobot_framer_t *framer)
{
    mycobot_event_t event;
#ifdef DEFECT_ONE_FRAME_PER_READ
    if (mycobot_framer_next(framer, &event)) {
#else
    while (mycobot_framer_next(framer, &event)) {
#endif
        take(&event);
    }
}

#ifdef DEFECT_FLOW_CONTROL
/* XON and XOFF are taken for flow control, as a terminal does by default. */
static ssize_t without_flow_control(uint8_t *data, ssize_t size)
{
    ssize_t from, to = 0;
    for (from = 0; from < size; from++) {
        if (data[from] != 0x11 && data[from] != 0x13) {
            data[to++] = data[from];
        }
    }
    return to;
}
#endif

static void serve(void)
{
    mycobot_framer_t framer;
    struct pollfd waiting;
#ifdef DEFECT_SHORT_BUFFER
    uint8_t data[16];
#else
    uint8_t data[256];
#endif

    waiting.fd = line;
    waiting.events = POLLIN;
    mycobot_framer_init(&framer, MYCOBOT_LISTEN_REQUESTS, false);
    for (;;) {
        const int ready = poll(&waiting, 1, IDLE_MS);
        ssize_t size = 0, fed = 0;
        if (ready > 0) {
            size = read(line, data, sizeof data);
            if (size < 0) {
                usleep(10000); /* no program has opened the port yet */
                continue;
            }
        } else {
#ifndef DEFECT_NEVER_FLUSHES
            mycobot_framer_flush(&framer);
#endif
#ifndef DEFECT_ONE_FRAME_PER_READ
            take_all(&framer);
#endif
        }
#ifdef DEFECT_TERMINAL_ECHO
        send_bytes(data, (size_t)size);
#endif
#ifdef DEFECT_FLOW_CONTROL
        size = without_flow_control(data, size);
#endif
        while (fed < size) {
            fed += (ssize_t)mycobot_framer_feed(&framer, data + fed, (size_t)(size - fed));
            take_all(&framer);
        }
#ifdef DEFECT_SHORT_BUFFER
        tcflush(line, TCIFLUSH);
#endif
    }
}

int main(void)
{
    struct termios modes;
    int i, kept;

    line = posix_openpt(O_RDWR | O_NOCTTY);
    if (line < 0 || grantpt(line) || unlockpt(line)) {
        return 1;
    }
    /* Kept open, so that a client may come and go. */
    kept = open(ptsname(line), O_RDWR | O_NOCTTY);
    if (kept < 0 || tcgetattr(kept, &modes)) {
        return 1;
    }
    cfmakeraw(&modes);
    tcsetattr(kept, TCSANOW, &modes);
    for (i = 0; i < JOINTS * 5; i++) {
        arm.registers[i / 5][i % 5] = 10;
    }
    printf("%s\n", ptsname(line));
    fflush(stdout);
    serve();
    return 0;
}
