// avr8js as `make deps` installs it: outside the sources, in build/second, so that the tree stays clean.
import { createRequire } from 'node:module';

export const AVR8JS_FOLDER = new URL('../build/second/', import.meta.url);
export const avr = createRequire(AVR8JS_FOLDER)('avr8js');
