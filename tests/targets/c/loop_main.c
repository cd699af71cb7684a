/* Provides the functions that the guide's loop calls; its line is standard input and output. */
#include <stdint.h>
#include <stdio.h>

int line_read(void);
void line_write(const uint8_t *data, size_t size);
int32_t joint_angle(int joint);
void serve(void);

int line_read(void)
{
    return getchar();
}

void line_write(const uint8_t *data, size_t size)
{
    fwrite(data, 1, size, stdout);
}

int32_t joint_angle(int joint)
{
    return joint == 1 ? 9000 : joint == 2 ? -9000 : 0;
}

int main(void)
{
    serve();
    return 0;
}
