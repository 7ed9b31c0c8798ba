/* Included inside a handler: a read of seam_length bytes. */
switch (STATUS()) {
case 0x08:
    SEND(seam_address);
    break;
case 0x18:
    START();
    break;
case 0x10:
    SEND((uint8_t)(seam_address | 1u));
    break;
case 0x50:
    seam_buffer[seam_index++] = RECEIVED();
    RECEIVE((uint8_t)(seam_index + 1u) < seam_length);
    break;
case 0x40:
    RECEIVE(seam_length > 1u);
    break;
case 0x58:
    seam_buffer[seam_index] = RECEIVED();
    STOP();
    seam_state = 1;
    break;
default:
    STOP();
    seam_state = 2;
    break;
}
