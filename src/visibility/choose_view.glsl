// Which shadow view a receiver looks at: a spot's one, the face of a cube, or a cascade.
#ifndef GNOMON_VISIBILITY_CHOOSE_VIEW_GLSL
#define GNOMON_VISIBILITY_CHOOSE_VIEW_GLSL

#include "visibility/cascades.glsl"

// Cascades: the first one that holds it. It is blended by `border` with the next one,
// or, if it is the last one, into light.
struct ViewChoice {
    uint view;
    float border;  // 0: this view alone
    bool none;     // no view holds the receiver: nothing shadows it
    bool last;     // beyond this view is light
};

ViewChoice chooseView(GpuLight light, Receiver receiver) {
    ViewChoice choice = ViewChoice(light.shadowView, 0.0, false, true);
    if (hasShadowViews(light, kShadowViewsCascades)) {
        uint count = cascadeCount(light);
        uint cascade = cascadeOf(light, receiver.positionWs, choice.border);
        choice.view += cascade;
        choice.none = cascade == count;
        choice.last = cascade + 1u >= count;
        float ignored;
        if (choice.border > 0.0 && !choice.last && !cascadeHolds(choice.view + 1u, receiver.positionWs, ignored)) {
            choice.border = 0.0;
        }
    } else if (hasShadowViews(light, kShadowViewsSixFaces)) {
        choice.view += cubeFace(receiver.positionWs - light.positionWs);
    }
    return choice;
}

#endif
