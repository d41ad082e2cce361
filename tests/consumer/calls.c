/* A C program that asks for measures and compares models by name, as a user would link it. */
#include <halflit/halflit.h>

#include <stdio.h>
#include <string.h>

int main(void) {
    halflit_answer* answer = NULL;
    if (halflit_call("measure", "{\"path\": \"sphere:500\"}", NULL, &answer) != 0) {
        fprintf(stderr, "%s\n", halflit_last_error());
        return 1;
    }
    const int measured = strstr(halflit_answer_report(answer), "\"volume\":") != NULL;
    halflit_answer_destroy(answer);
    if (halflit_call("render", "{\"path\": \"demo\", \"size\": [32, 24]}", NULL, &answer) != 0) return 1;
    int32_t width = 0;
    const int drawn = halflit_answer_picture(answer, &width, NULL) != NULL && width == 32;
    halflit_answer_destroy(answer);
    printf("measured %d, drawn %d\n", measured, drawn);
    return measured && drawn ? 0 : 1;
}
