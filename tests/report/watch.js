// Put before everything else in the page under test: nothing may be said on the console.
window.said = [];
addEventListener('error', event => said.push('error: ' + event.message));
addEventListener('unhandledrejection', event => said.push('rejected: ' + event.reason));
for (const level of ['error', 'warn']) {
  const usual = console[level];
  console[level] = (...words) => { said.push(`${level}: ${words.join(' ')}`); usual(...words); };
}
