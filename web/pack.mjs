// node web/pack.mjs OUT: the demo page's worker with all that it imports, as one script. esbuild is where tools/deps.sh puts it.
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';

const root = new URL('../', import.meta.url);
const { build } = createRequire(new URL('build/web/', root))('esbuild');
const AVR8JS = fileURLToPath(new URL('build/second/node_modules/avr8js/dist/esm/index.js', root));

// second/avr8js.mjs loads avr8js as Node does; here its modules are taken into the script
const avr8js = {
  name: 'avr8js',
  setup(pack) {
    const contents = `import * as avr from ${JSON.stringify(AVR8JS)};\nexport { avr };`;
    pack.onLoad({ filter: /second[/\\]avr8js\.mjs$/ }, () => ({ contents, loader: 'js' }));
  },
};

await build({
  entryPoints: [fileURLToPath(new URL('worker/worker.mjs', import.meta.url))], outfile: process.argv[2], bundle: true, minify: true, format: 'iife',
  target: 'es2022', legalComments: 'none', plugins: [avr8js], logLevel: 'warning',
});
